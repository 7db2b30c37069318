#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "harness/draw/scene.h"

namespace parallax::harness {

/// What all pictures of a run show. A picture's shapes outside it are moved to its border.
struct SceneFrame {
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();  // [m]
};

enum class ViewKind : std::uint8_t { kAbove, kSide };

struct Rectangle {
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();  // [px]
  Eigen::Vector2d size() const { return high - low; }
  bool meets(const Rectangle& other) const {
    return (low.array() < other.high.array()).all() && (other.low.array() < high.array()).all();
  }
  bool holds(const Rectangle& other) const {
    return (low.array() <= other.low.array()).all() && (other.high.array() <= high.array()).all();
  }
};
Rectangle around(const std::vector<Eigen::Vector2d>& points);

/// Convex hull, counter-clockwise (Andrew 1979).
std::vector<Eigen::Vector2d> hull(std::vector<Eigen::Vector2d> points);

/// With the first point again at the end.
std::vector<Eigen::Vector2d> closed(std::vector<Eigen::Vector2d> points);

/// "12.0,3.4 56.7,8.9", as polygons and polylines list their points.
std::string point_list(const std::vector<Eigen::Vector2d>& points);

/// From the world to the pixels of one view: from above x is to the right and y up; from the side,
/// looking along +y, x is to the right and z up.
class Projection {
 public:
  Projection(const SceneFrame& frame, ViewKind kind, double left_px, double top_px, double px_per_m)
      : frame_(frame), kind_(kind), left_px_(left_px), top_px_(top_px), px_per_m_(px_per_m) {}

  ViewKind kind() const { return kind_; }
  const SceneFrame& frame() const { return frame_; }
  double top_m() const { return kind_ == ViewKind::kAbove ? frame_.high.y() : frame_.high.z(); }
  double bottom_m() const { return kind_ == ViewKind::kAbove ? frame_.low.y() : frame_.low.z(); }
  double width_px() const { return px_per_m_ * (frame_.high.x() - frame_.low.x()); }
  double height_px() const { return px_per_m_ * (top_m() - bottom_m()); }
  Rectangle area() const {
    return {{left_px_, top_px_}, {left_px_ + width_px(), top_px_ + height_px()}};
  }

  Eigen::Vector2d pixel(const Eigen::Vector3d& p_W) const;
  std::vector<Eigen::Vector2d> pixels(const std::vector<Eigen::Vector3d>& points_W) const;
  std::vector<Eigen::Vector2d> outline(const Probe& box) const;
  /// Of the face that the viewer looks at; greater is nearer [m].
  double nearness(const Probe& box) const;

 private:
  SceneFrame frame_;
  ViewKind kind_;
  double left_px_, top_px_, px_per_m_;
};

}  // namespace parallax::harness
