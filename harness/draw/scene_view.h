#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/draw/label_layout.h"
#include "harness/draw/projection.h"
#include "harness/draw/scene.h"
#include "harness/region/region.h"

namespace parallax::harness {

/// Of what went wrong.
inline constexpr const char* kWarningColour = "#c00020";

/// The colour of a kind's outlines and names.
const char* line_colour(SceneKind kind);

/// One of the two views of a picture: which axes lie in it, what is nearer, and where text is still
/// free. Everything it returns is SVG. `scene` outlives it.
class SceneView {
 public:
  SceneView(const Projection& projection, const Scene& scene);

  const Projection& projection() const { return projection_; }

  /// The boxes, far ones first and opaque, with the outlines of those that other bodies cover
  /// dotted on top, and the arms between shoulders and hands.
  std::string bodies() const;
  /// The floor, where it is a line.
  std::string floor() const;
  /// Outlines of the regions of the world's frame. An axis on which a region is not bounded, it
  /// fills.
  std::string regions(const RegionMap& regions) const;
  /// The names of items, drawers, the robot's base, furniture and hands; those of `warned` in the
  /// colour of warnings, and first.
  std::string body_names(const std::vector<std::string>& warned);
  std::string region_names(const RegionMap& regions);
  /// The two axes with their names, below the lower left corner.
  std::string axes() const;

 private:
  struct Body {
    SceneKind kind = SceneKind::kFurniture;
    std::vector<Eigen::Vector2d> points;  // of the outlines of all boxes
  };
  std::string polygon(const SceneBox& item) const;
  std::string covered() const;
  std::string arms() const;

  Projection projection_;
  const Scene& scene_;
  std::vector<const SceneBox*> order_;  // far ones first
  std::map<std::string, Body> bodies_;
  LabelLayout labels_;
};

}  // namespace parallax::harness
