#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "harness/draw/scene.h"
#include "harness/region/region.h"

namespace parallax::harness {

/// What all pictures of a run show. A picture's shapes outside it are moved to its border.
struct SceneFrame {
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();  // [m]
};

enum class ViewKind : std::uint8_t { kAbove, kSide };

/// One of the two views of a picture: which axes lie in it, what is nearer, and where text is still
/// free. Everything it returns is SVG.
class SceneView {
 public:
  SceneView(const SceneFrame& frame, ViewKind kind, double left_px, double top_px, double px_per_m)
      : frame_(frame), kind_(kind), left_px_(left_px), top_px_(top_px), px_per_m_(px_per_m) {}

  double width_px() const { return px_per_m_ * (frame_.high.x() - frame_.low.x()); }
  double height_px() const { return px_per_m_ * (top() - bottom()); }
  double bottom_px() const { return top_px_ + height_px(); }

  /// The boxes, far ones first, and the arms between shoulders and hands.
  std::string scene(const Scene& scene) const;
  /// The floor, where it is a line.
  std::string floor() const;
  /// Outlines of the regions of the world's frame, with their names. An axis on which a region is
  /// not bounded, it fills.
  std::string regions(const RegionMap& regions);
  /// The names of the items beside them.
  std::string item_names(const Scene& scene);
  /// The two axes with their names, below the lower left corner.
  std::string axes() const;

 private:
  struct Label {
    Eigen::Vector2d low, high;  // [px]
  };
  double top() const { return kind_ == ViewKind::kAbove ? frame_.high.y() : frame_.high.z(); }
  double bottom() const { return kind_ == ViewKind::kAbove ? frame_.low.y() : frame_.low.z(); }
  Eigen::Vector2d pixel(const Eigen::Vector3d& p_W) const;
  std::vector<Eigen::Vector2d> outline(const Probe& box) const;
  double nearness(const SceneBox& item) const;
  std::string polygon(const SceneBox& item) const;
  /// Text at the first of the places (left end of its base line) where no other text is; where all
  /// are taken, at the first.
  std::string label(const std::string& text, const char* colour,
                    const std::vector<Eigen::Vector2d>& places);

  SceneFrame frame_;
  ViewKind kind_;
  double left_px_, top_px_, px_per_m_;
  std::vector<Label> labels_;
};

}  // namespace parallax::harness
