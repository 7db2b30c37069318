#include "harness/engine/region_support.h"

#include <algorithm>

#include "harness/engine/ode_world.h"
#include "harness/engine/solid_boxes.h"

namespace parallax::harness {
namespace {

constexpr double kPlay_m = 0.005;
constexpr double kProbe_m = 0.004;  // edge of the box that stands for a point

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

std::vector<std::string> unsupported_points(const WorldSpec& spec,
                                            const std::vector<NamedPoint>& points) {
  const OdeWorld world(spec);
  const WorldLayout& layout = world.layout();
  BodyMask ignored(layout.bodies.size(), false);
  const auto base = layout.find_body(base_body(spec));
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const bool robot = base && layout.assembly_of[i] == layout.assembly_of[base->index()];
    ignored[i] = layout.is_free[i] || (robot && layout.link_of[i]);
  }
  std::vector<std::string> found;
  for (const NamedPoint& point : points) {
    const Probe probe{Eigen::Vector3d::Constant(kProbe_m), point.p_W, Eigen::Matrix3d::Identity()};
    if (!world.find_obstacle(probe, ignored, 0.0)) found.push_back(point.name);
  }
  return found;
}

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

std::vector<BuriedBox> buried_boxes(const WorldSpec& spec, const std::vector<NamedBox>& boxes) {
  const WorldLayout layout = lay_out(spec);
  std::vector<BuriedBox> found;
  for (const NamedBox& box : boxes) {
    // What lies on a body is just above its top.
    const Eigen::Vector3d high = box.high_W + Eigen::Vector3d(0.0, 0.0, kPlay_m);
    const SolidBox region{high - box.low_W, 0.5 * (box.low_W + high), 0.0};
    for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
      if (layout.link_of[i]) continue;
      const BodySpec& body = layout.bodies[layout.bodies.id_at(i)];
      const auto solids = solid_boxes(body);
      const bool inside = std::any_of(solids.begin(), solids.end(), [&](const SolidBox& solid) {
        return solid.contains(region);
      });
      if (!inside) continue;
      found.push_back({box.name, body.name});
      break;
    }
  }
  return found;
}

}  // namespace parallax::harness
