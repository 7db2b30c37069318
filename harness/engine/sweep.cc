#include "harness/engine/sweep.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace parallax::harness {

Sweep::Sweep(const OdeWorld& world, const BodyMask& bodies, const BodyMask& ignored,
             double tolerance_m)
    : world_(world), ignored_(ignored), tolerance_m_(std::max(tolerance_m, 0.0)) {
  const Eigen::Vector3d room = Eigen::Vector3d::Constant(2.0 * std::max(-tolerance_m, 0.0));
  const WorldLayout& layout = world.layout();
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (!bodies[i]) continue;
    ignored_[i] = true;
    const BodyId id = layout.bodies.id_at(i);
    if (!layout.bodies[id].collides) continue;
    for (const BoxShape& shape : layout.bodies[id].shapes) {
      Probe box = world.placed(id, shape);
      box.size_m += room;
      parts_.push_back({layout.bodies[id].name, box});
    }
  }
}

std::optional<Obstacle> Sweep::at(const Eigen::Vector3d& offset, const Eigen::Vector3d& axis_W,
                                  double angle_rad) const {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (const Part& part : parts_) {
    const Eigen::Vector3d p = axis_W + turn * (part.probe.p_WS + offset - axis_W);
    const Probe moved{part.probe.size_m, p, turn * part.probe.R_WS};
    if (const auto hit = world_.find_obstacle(moved, ignored_, tolerance_m_)) {
      return Obstacle{part.name, hit->first, 0.0};
    }
  }
  return std::nullopt;
}

std::optional<Obstacle> Sweep::along(const Eigen::Vector3d& offset, const Eigen::Vector3d& way,
                                     double step_m) const {
  const int steps = std::max(1, static_cast<int>(std::ceil(way.norm() / step_m)));
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    if (auto hit = at(offset + share * way, Eigen::Vector3d::Zero(), 0.0)) {
      hit->way_m = share * way.norm();
      return hit;
    }
  }
  return std::nullopt;
}

std::optional<Obstacle> Sweep::turning(const Eigen::Vector3d& offset, const Eigen::Vector3d& axis_W,
                                       double angle_rad, double step_rad) const {
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(angle_rad) / step_rad)));
  for (int i = 0; i <= steps; ++i) {
    if (auto hit = at(offset, axis_W, angle_rad * i / steps)) return hit;
  }
  return std::nullopt;
}

}  // namespace parallax::harness
