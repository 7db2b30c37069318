// Tries a motion without moving anything.
//
// The shapes of the moving bodies are put at evenly spaced places along a straight way, or at
// headings of a turn, and the engine is asked at each whether they overlap something by more
// than the tolerance. The first hit ends it. For a straight way the hit also tells how much room
// is missing across it: seen along the way, both boxes are convex polygons whose sides are edges
// of the boxes, so the least shift that parts them is found along the normals of these sides,
// exactly. An obstacle thinner than a step may be passed over. Cost: steps times shapes.

#include "harness/engine/sweep.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace parallax::harness {
namespace {

struct SlabExtent {
  double low = 0.0, high = 0.0;
};

SlabExtent extent_along(const Probe& box, const Eigen::Vector3d& direction) {
  const double middle = box.p_WS.dot(direction);
  const double half =
      0.5 * (box.R_WS.transpose() * direction).cwiseAbs().dot(box.size_m.cwiseAbs());
  return {middle - half, middle + half};
}

/// By how much two boxes, or the boxes round shapes, overlap, seen along `ahead`: the least shift
/// across it that takes them apart, sideways if the way is level; 0 where one passes the other.
/// Exact, because both look like convex polygons, whose sides are edges of the boxes.
double overlap_across(const Probe& a, const Probe& b, const Eigen::Vector3d& ahead) {
  constexpr double kSmall = 1e-9;
  const bool level = std::abs(ahead.z()) < kSmall;
  double least = std::numeric_limits<double>::infinity();
  for (const Probe* box : {&a, &b}) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Eigen::Vector3d normal = ahead.cross(box->R_WS.col(i));
      if (normal.norm() < kSmall) continue;
      const Eigen::Vector3d across = normal.normalized();
      const SlabExtent one = extent_along(a, across), other = extent_along(b, across);
      const double overlap = std::min(one.high - other.low, other.high - one.low);
      if (overlap <= 0.0) return 0.0;
      if (!level || std::abs(across.z()) < kSmall) least = std::min(least, overlap);
    }
  }
  if (level) {
    const Eigen::Vector3d across = ahead.cross(Eigen::Vector3d::UnitZ());
    const SlabExtent one = extent_along(a, across), other = extent_along(b, across);
    least = std::min({least, one.high - other.low, other.high - one.low});
  }
  return std::max(least, 0.0);
}

}  // namespace

Sweep::Sweep(const PhysicsWorld& world, const BodyMask& bodies, const BodyMask& ignored,
             double tolerance_m)
    : world_(world), ignored_(ignored), tolerance_m_(std::max(tolerance_m, 0.0)) {
  const Eigen::Vector3d room = Eigen::Vector3d::Constant(2.0 * std::max(-tolerance_m, 0.0));
  const WorldLayout& layout = world.layout();
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (!bodies[i]) continue;
    ignored_[i] = true;
    const BodyId id = layout.bodies.id_at(i);
    if (!layout.bodies[id].collides) continue;
    for (const BodyShape& shape : layout.bodies[id].shapes) {
      Probe box = world.placed(id, shape);
      if (!room.isZero(0.0) && box.form == ShapeForm::kHull) {
        box.form = ShapeForm::kBox;  // room all round is asked of the box round it
        box.hull = nullptr;
      }
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
    const Probe moved{part.probe.size_m, p, turn * part.probe.R_WS, part.probe.form,
                      part.probe.hull};
    if (const auto hit = world_.find_obstacle(moved, ignored_, tolerance_m_)) {
      return Obstacle{part.name, hit->first, 0.0};
    }
  }
  return std::nullopt;
}

std::optional<double> Sweep::clearance_of(const Obstacle& hit, const Eigen::Vector3d& offset,
                                          const Eigen::Vector3d& way) const {
  const auto id = world_.layout().find_body(hit.obstacle);
  if (!id || way.norm() == 0.0) return std::nullopt;
  const Eigen::Vector3d ahead = way.normalized();
  double most = 0.0;
  for (const Part& part : parts_) {
    if (part.name != hit.part) continue;
    const Probe moved{part.probe.size_m, part.probe.p_WS + offset, part.probe.R_WS, part.probe.form,
                      part.probe.hull};
    const SlabExtent begin = extent_along(moved, ahead);
    for (const BodyShape& shape : world_.layout().bodies[*id].shapes) {
      const Probe box = world_.placed(*id, shape);
      const SlabExtent there = extent_along(box, ahead);
      if (there.high < begin.low || there.low > begin.high + way.norm()) continue;
      most = std::max(most, overlap_across(moved, box, ahead));
    }
  }
  return -most;
}

std::optional<Obstacle> Sweep::along(const Eigen::Vector3d& offset, const Eigen::Vector3d& way,
                                     double step_m) const {
  const int steps = std::max(1, static_cast<int>(std::ceil(way.norm() / step_m)));
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    if (auto hit = at(offset + share * way, Eigen::Vector3d::Zero(), 0.0)) {
      hit->way_m = share * way.norm();
      hit->clearance_m = clearance_of(*hit, offset, way);
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
