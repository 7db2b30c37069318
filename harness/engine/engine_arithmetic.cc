#include "harness/engine/engine_arithmetic.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "harness/engine/engine_module.h"
#include "harness/engine/physics_world.h"

namespace parallax::harness {
namespace {

constexpr int kSteps = 250;  // half a second: the last body has fallen and turned over by then

BodySpec body(std::string name, ShapeForm form, const Eigen::Vector3d& size_m,
              const Eigen::Vector3d& p_WB, double yaw_rad) {
  BodySpec out;
  out.name = std::move(name);
  out.mass_kg = 0.3;
  out.p_WB = p_WB;
  out.yaw_rad = yaw_rad;
  BodyShape shape;
  shape.form = form;
  shape.size_m = size_m;
  out.shapes.push_back(shape);
  return out;
}

WorldSpec fixed_world() {
  WorldSpec spec;
  spec.bodies.push_back(body("lower", ShapeForm::kBox, {0.1, 0.13, 0.07}, {0, 0, 0.05}, 0.3));
  // Over the edge of the lower one.
  spec.bodies.push_back(
      body("upper", ShapeForm::kBox, {0.11, 0.06, 0.08}, {0.052, 0.013, 0.15}, 0.9));
  spec.bodies.push_back(
      body("ball", ShapeForm::kSphere, {0.06, 0.06, 0.06}, {-0.04, 0.02, 0.26}, 0.0));
  spec.bodies.push_back(
      body("pendulum", ShapeForm::kCapsule, {0.04, 0.04, 0.3}, {1.0, 0.0, 0.8}, 0.0));
  JointSpec hinge;
  hinge.name = "pivot";
  hinge.type = JointType::kHinge;
  hinge.child = "pendulum";
  hinge.axis_W = Eigen::Vector3d::UnitY();
  hinge.p_WA = {0.93, 0.0, 0.93};
  hinge.max_torque_nm = 0.0;
  spec.joints.push_back(hinge);
  return spec;
}

}  // namespace

std::string engine_digits(EngineKind engine) {
  if (!has_engine(engine)) return "none";
  auto spec = fixed_world();
  spec.engine = engine;
  const auto world = make_world(spec);
  world->enter_thread();
  std::vector<Placement> placements;
  for (const auto& one : world->layout().bodies) placements.push_back({one.p_WB, one.yaw_rad});
  world->reset(placements, 1);
  for (int i = 0; i < kSteps; ++i) {
    if (!world->step()) break;
  }
  return fmt::format("{:016x}", world->digest());
}

}  // namespace parallax::harness
