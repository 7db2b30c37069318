#include "harness/world/region_support.h"

#include <algorithm>

#include "harness/world/ode_world.h"

namespace parallax::harness {
namespace {

/// Of all free bodies, each standing on its longest edge.
double stack_height_m(const OdeWorld& world) {
  const WorldLayout& layout = world.layout();
  double height_m = 0.0;
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (!layout.is_free[i]) continue;
    const Bounds bounds = world.bounds(layout.bodies.id_at(i));
    height_m += (bounds.high - bounds.low).maxCoeff();
  }
  return height_m;
}

double longest_travel_m(const WorldLayout& layout) {
  double travel_m = 0.0;
  for (const JointSpec& joint : layout.sliders) {
    if (joint.low_m && joint.high_m) travel_m = std::max(travel_m, *joint.high_m - *joint.low_m);
  }
  return travel_m;
}

}  // namespace

std::vector<std::string> boxes_without_support(const WorldSpec& spec,
                                               const std::vector<NamedBox>& boxes) {
  const OdeWorld world(spec);
  const WorldLayout& layout = world.layout();
  const double stack_m = stack_height_m(world);
  const Eigen::Vector3d travel_m = Eigen::Vector3d::Constant(longest_travel_m(layout));
  std::vector<std::string> found;
  for (const NamedBox& box : boxes) {
    if (box.low_W.z() <= stack_m) continue;
    const Eigen::Vector3d low = box.low_W - travel_m, high = box.high_W + travel_m;
    const Probe probe{high - low, 0.5 * (low + high), Eigen::Matrix3d::Identity()};
    if (!world.find_obstacle(probe, layout.is_free, 0.0)) found.push_back(box.name);
  }
  return found;
}

}  // namespace parallax::harness
