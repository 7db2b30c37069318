#include "tools/bench/engines/grip_trials.h"

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/contract.h"
#include "harness/engine/physics_world.h"
#include "harness/robot/mobile_robot.h"
#include "harness/sampling/sampler.h"

namespace parallax::tools {
namespace {

using Eigen::Vector3d;
using harness::BodyShape;
using harness::BodySpec;
using harness::JointSpec;
using harness::Motion;
using harness::WorldSpec;

constexpr double kEarth_m_s2 = 9.81;
constexpr double kTable_m = 0.71;
constexpr Motion kLift{0.10, 0.3, 0.001, 10.0}, kTouch{0.02, 1.0, 0.0005, 10.0};
constexpr double kCloseSpeed_m_s = 0.05, kOpening_m = 0.12, kPad_m = 0.010;

BodySpec body(std::string name, std::vector<BodyShape> shapes, const Vector3d& p_WB, double mass_kg,
              std::string material) {
  BodySpec made;
  made.name = std::move(name);
  made.shapes = std::move(shapes);
  made.p_WB = p_WB;
  made.mass_kg = mass_kg;
  made.material = std::move(material);
  return made;
}

JointSpec joint(std::string name, harness::JointType type, std::string parent, std::string child) {
  JointSpec made;
  made.name = std::move(name);
  made.type = type;
  made.parent = std::move(parent);
  made.child = std::move(child);
  return made;
}

/// A prism of `sides` round the z axis with flat sides at x and y; `chamfer_m` of it is taken off
/// its upper and lower edges.
BodyShape prism(int sides, double width_m, double height_m, double chamfer_m) {
  std::vector<std::pair<double, double>> rings;  // radius to the corners, height
  const double radius_m = 0.5 * width_m / std::cos(std::numbers::pi / sides);
  const double half_m = 0.5 * height_m;
  if (chamfer_m > 0.0) {
    rings = {{radius_m - chamfer_m, -half_m},
             {radius_m, -half_m + chamfer_m},
             {radius_m, half_m - chamfer_m},
             {radius_m - chamfer_m, half_m}};
  } else {
    rings = {{radius_m, -half_m}, {radius_m, half_m}};
  }
  std::vector<Vector3d> corners;
  for (const auto& [radius, height] : rings) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * std::numbers::pi * (i + 0.5) / sides;
      corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
    }
  }
  std::vector<std::array<std::uint32_t, 3>> faces;
  const auto n = static_cast<std::uint32_t>(sides);
  const auto last = static_cast<std::uint32_t>(rings.size() - 1) * n;
  for (std::uint32_t ring = 0; ring < last; ring += n) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = ring + i, b = ring + (i + 1) % n;
      faces.push_back({a, b, b + n});
      faces.push_back({a, b + n, a + n});
    }
  }
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    faces.push_back({0, i + 1, i});
    faces.push_back({last, last + i, last + i + 1});
  }
  BodyShape shape;
  std::string why;
  auto hull = harness::hull_with(corners, faces, shape.p_BS, why);
  PARALLAX_REQUIRE(hull.has_value(), "a prism that is convex");
  shape.form = harness::ShapeForm::kHull;
  shape.size_m = hull->size_m;
  shape.hull = std::make_shared<const harness::ConvexHull>(std::move(*hull));
  return shape;
}

/// A bowl as `ring` of a scenario makes it: a bottom and a ring of walls.
std::vector<BodyShape> ring(int sides, double width_m, double height_m, double wall_m) {
  const double bottom_m = width_m * std::numbers::sqrt2 / 2.0 - wall_m;
  std::vector<BodyShape> shapes{
      {{bottom_m, bottom_m, wall_m}, {0.0, 0.0, -0.5 * (height_m - wall_m)}}};
  const double radius_m = 0.5 * (width_m - wall_m);
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    shapes.push_back({{wall_m, width_m * std::tan(std::numbers::pi / sides), height_m},
                      {radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0},
                      angle});
  }
  return shapes;
}

/// The random numbers of one trial.
struct Draw {
  explicit Draw(std::uint64_t seed) : rng(harness::DrawKey{seed, 0x67726970}) {}
  double between(double low, double high) { return low + (high - low) * rng.uniform(next++); }
  int one_of(std::initializer_list<int> all) { return all.begin()[rng.bits(next++) % all.size()]; }
  harness::CounterRng rng;
  std::uint64_t next = 0;
};

std::vector<BodyShape> load_of(GripForm form, double width_m, double height_m, Draw& draw) {
  switch (form) {
    case GripForm::kBox:
      return {{{draw.between(0.03, 0.09), width_m, height_m}}};
    case GripForm::kRing:
      return ring(draw.one_of({8, 12, 16}), width_m, height_m, draw.between(0.004, 0.012));
    case GripForm::kHull:
      return {prism(draw.one_of({4, 8, 12}), width_m, height_m, 0.0)};
    case GripForm::kCylinder: {
      BodyShape shape{{width_m, width_m, height_m}};
      shape.form = harness::ShapeForm::kCylinder;
      return {shape};
    }
    case GripForm::kMesh:
      return {prism(16, width_m, height_m, draw.between(0.004, 0.010))};
  }
  return {};
}

/// Bodies and joints of the robot: a base, a hand on a gantry, two pads.
void add_robot(WorldSpec& spec, double tool_m, double pads_m) {
  using harness::JointType;
  const double hand_m = 0.40;
  spec.bodies.push_back(body("chassis", {{{0.5, 0.5, 0.4}}}, {-0.25, 0.0, 0.23}, 90.0, "robot"));
  spec.bodies.push_back(
      body("hand", {{{0.06, 0.10, 0.05}}}, {hand_m, tool_m, pads_m + 0.11}, 0.6, "robot"));
  const auto pad = [&](const char* name, double y) {
    spec.bodies.push_back(body(name,
                               {{{0.03, kPad_m, 0.03}}, {{0.012, 0.008, 0.072}, {0.0, 0.0, 0.049}}},
                               {hand_m, tool_m + y, pads_m}, 0.12, "pad"));
  };
  pad("near", -0.5 * (kOpening_m + kPad_m));
  pad("far", 0.5 * (kOpening_m + kPad_m));
  JointSpec wheels = joint("wheels", JointType::kGantry, "", "chassis");
  wheels.max_force_n = 300.0;
  wheels.max_torque_nm = 80.0;
  JointSpec arm = joint("arm", JointType::kGantry, "chassis", "hand");
  arm.max_force_n = 250.0;
  arm.max_torque_nm = 20.0;
  JointSpec finger = joint("finger", JointType::kSlider, "hand", "far");
  finger.axis_W = Vector3d::UnitY();
  finger.low_m = -kOpening_m;
  finger.high_m = 0.01;
  finger.max_force_n = 60.0;
  spec.joints = {wheels, arm, joint("weld", JointType::kFixed, "hand", "near"), finger};
  spec.mobile.emplace();
  spec.mobile->base_joint = "wheels";
  spec.mobile->base_body = "chassis";
  harness::ArmSpec hand;
  hand.name = "arm";
  hand.joint = "arm";
  hand.finger_joint = "finger";
  hand.palm_body = "hand";
  hand.near_pad_body = "near";
  hand.far_pad_body = "far";
  hand.opening_m = kOpening_m;
  spec.mobile->arms = {hand};
}

}  // namespace

std::string_view to_string(GripForm form) {
  switch (form) {
    case GripForm::kBox:
      return "box";
    case GripForm::kRing:
      return "ring";
    case GripForm::kHull:
      return "hull";
    case GripForm::kCylinder:
      return "cylinder";
    case GripForm::kMesh:
      return "mesh";
  }
  return {};
}

GripTrial try_grip(const GripCell& cell, std::uint64_t seed, const harness::SolverSpec& solver) {
  Draw draw(seed);
  const double width_m = draw.between(0.05, 0.09), height_m = draw.between(0.07, 0.11);
  const double friction = draw.between(0.2, 0.6), squeeze_n = draw.between(15.0, 40.0);
  const double speed_m_s = draw.between(0.3, 0.8), acceleration_m_s2 = draw.between(0.5, 1.5);
  const double heading_rad = draw.between(-0.5, 0.5), turn_rad = draw.between(-1.0, 1.0);
  // Both are small beside the pads, so that they hold the load against turning as well.
  const double aside_m = draw.between(-0.002, 0.002), above_m = draw.between(-0.01, 0.01);
  const double off_m = draw.between(-0.004, 0.004), yaw_rad = draw.between(-0.05, 0.05);
  const double pull_m_s2 = std::hypot(kEarth_m_s2 + kLift.acceleration_m_s2, acceleration_m_s2);

  WorldSpec spec;
  spec.engine = cell.engine;
  spec.solver = solver;
  spec.solver.timestep_s = cell.timestep_s;
  spec.friction.fallback = 0.5;
  spec.friction.pairs[{"load", "pad"}] = friction;
  const double load_m = kTable_m + 0.5 * height_m;
  spec.bodies = {body("table", {{{0.4, 0.6, 0.02}}}, {0.45, 0.0, kTable_m - 0.01}, 0.0, "wood"),
                 body("load", load_of(cell.form, width_m, height_m, draw),
                      {0.40 + aside_m, 0.0, load_m}, 1.0, "load")};
  spec.bodies.back().mass_kg = 2.0 * friction * squeeze_n / (cell.margin * pull_m_s2);
  spec.bodies.back().yaw_rad = cell.straight ? 0.0 : yaw_rad;
  const double clearance_m = 0.5 * (kOpening_m - width_m);
  add_robot(spec, clearance_m - 0.012 + off_m, load_m + above_m);

  const auto world = harness::make_world(spec);
  harness::MobileRobot robot(spec, *world);
  std::vector<harness::Placement> start;
  for (const auto& one : world->layout().bodies) start.push_back({one.p_WB, one.yaw_rad, 0.0});
  PARALLAX_REQUIRE(!world->reset(start, 1), "bodies that do not overlap");
  robot.reset();
  harness::Arm& arm = robot.arms().front();
  const harness::BodyId load = *world->layout().find_body("load");
  const harness::BodyId hand = *world->layout().find_body("hand");
  const auto go_on = [&](double time_s, auto&& ends) {
    const auto steps = std::lround(time_s / cell.timestep_s);
    for (long i = 0; i < steps && !ends(); ++i) {
      robot.drive_motors();
      PARALLAX_REQUIRE(world->step(), "a world that stays sane");
    }
  };
  const auto never = [] { return false; };
  const auto stands = [&] { return robot.base().at_rest() && arm.tool_at_rest(); };
  const auto touch = [&] { return world->touch(load); };

  go_on(0.1, never);
  arm.move_tool_to(arm.tool() + Vector3d(0.0, 0.04, 0.0), kTouch);
  go_on(2.5, [&] { return touch().near_pad(); });
  arm.brake();
  go_on(0.1, never);
  arm.squeeze(squeeze_n, kCloseSpeed_m_s);
  go_on(3.0, [&] { return touch().far_pad(); });
  go_on(0.4, never);
  const Vector3d before_H =
      world->rotation(hand).transpose() * (world->position(load) - world->position(hand));
  const Eigen::Matrix3d turned_H = world->rotation(hand).transpose() * world->rotation(load);
  arm.move_tool_to(arm.tool() + 0.12 * Vector3d::UnitZ(), kLift);
  go_on(2.5, [&] { return arm.tool_at_rest(); });
  const Motion drive{speed_m_s, acceleration_m_s2, 0.005, 6.0};
  const Eigen::Vector2d back(-std::cos(heading_rad), -std::sin(heading_rad));
  robot.base().drive_to(robot.base().pose().p + 0.8 * back, drive);
  go_on(6.0, stands);
  robot.base().turn_to(turn_rad, {1.0, 1.5, 0.005, 6.0});
  go_on(3.0, stands);
  go_on(0.3, never);

  GripTrial trial;
  trial.unsolved = world->statistics().engine_messages;
  trial.solved_again = world->statistics().solved_again;
  trial.lost = !touch().near_pad() || !touch().far_pad();
  trial.slip_m =
      (world->rotation(hand).transpose() * (world->position(load) - world->position(hand)) -
       before_H)
          .norm();
  trial.turn_rad = Eigen::AngleAxisd(turned_H.transpose() * world->rotation(hand).transpose() *
                                     world->rotation(load))
                       .angle();
  return trial;
}

}  // namespace parallax::tools
