#include "harness/engine/physics_world.h"

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "harness/engine/engine_module.h"
#include "harness/engine/ode_world.h"
#include "harness/world/shapes.h"

namespace parallax::harness {

std::unique_ptr<PhysicsWorld> make_world(const WorldSpec& spec) {
  if (spec.engine == EngineKind::kOde) return std::make_unique<OdeWorld>(spec);
  return make_module_world(spec);
}

Probe PhysicsWorld::placed(BodyId id, const BodyShape& shape) const {
  const Eigen::Matrix3d R_WB = rotation(id);
  const Eigen::Vector3d p_WS = position(id) + R_WB * shape.p_BS;
  if (!is_upright_box(shape)) {
    return {shape.size_m, p_WS, R_WB * shape_rotation(shape), shape.form, shape.hull};
  }
  return {shape.size_m, p_WS, R_WB * Eigen::AngleAxisd(shape.yaw_rad, Eigen::Vector3d::UnitZ())};
}

BodyBounds PhysicsWorld::bounds(BodyId id, const BodyShape& shape) const {
  const Probe box = placed(id, shape);
  const auto [low, high] = span(box.form, box.size_m, box.hull.get(), box.R_WS);
  return BodyBounds{box.p_WS + low, box.p_WS + high};
}

BodyBounds PhysicsWorld::bounds(BodyId id) const {
  const std::vector<BodyShape>& shapes = layout().bodies[id].shapes;
  BodyBounds all = bounds(id, shapes.front());
  for (const BodyShape& shape : shapes) {
    const BodyBounds one = bounds(id, shape);
    all.low = all.low.cwiseMin(one.low);
    all.high = all.high.cwiseMax(one.high);
  }
  return all;
}

}  // namespace parallax::harness
