#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/draw/scene.h"
#include "harness/region/region.h"

namespace parallax::harness {

/// Finds places for the names in one view, so that none lies on another one.
class LabelLayout {
 public:
  explicit LabelLayout(const Rectangle& area) : area_(area) {}

  /// Names are kept off it as long as there is room elsewhere.
  void avoid(const Rectangle& what) { avoided_.push_back(what); }

  /// SVG of the text in or beside what it names, with a line to it where it stands apart. Empty:
  /// there is no room near it.
  std::string place(const std::string& name, const char* colour, const Rectangle& named);

 private:
  bool is_free(const Rectangle& box, bool strict) const;

  Rectangle area_;
  std::vector<Rectangle> texts_, avoided_;
};

/// The colour of things that went wrong.
inline constexpr const char* kWarningColour = "#c00020";

/// The colour of a kind's outlines and names.
const char* line_colour(SceneKind kind);

/// One of the two views of a picture: which axes lie in it, what is nearer, and where text is still
/// free. Everything it returns is SVG. `scene` and `bright` outlive it.
class SceneView {
 public:
  /// Bodies that are not among `bright` are drawn faint; null: none is.
  SceneView(const Projection& projection, const Scene& scene,
            const std::set<std::string>* bright = nullptr);

  const Projection& projection() const { return projection_; }

  /// The boxes, far ones first and opaque, with the outlines of those that other bodies cover
  /// dotted on top, and the arms between shoulders and hands.
  std::string bodies() const;
  /// The floor, where it is a line.
  std::string floor() const;
  /// Outlines of the regions of the world's frame. An axis on which a region is not bounded, it
  /// fills.
  std::string regions(const RegionMap& regions) const;
  /// One of them, dashed in a colour of its own; empty where it does not lie in the picture.
  std::string region(const Region& region, const char* colour) const;
  /// The names of items, drawers, the robot's base, furniture and hands; those of `warned` in the
  /// colour of warnings, and first.
  std::string body_names(const std::vector<std::string>& warned);
  std::string region_names(const RegionMap& regions);
  /// Another text beside what it names; no other one will lie on it.
  std::string label(const std::string& text, const char* colour, const Rectangle& named) {
    return labels_.place(text, colour, named);
  }
  /// Names are kept off it as long as there is room elsewhere.
  void keep_free(const Rectangle& what) { labels_.avoid(what); }
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
  bool is_faint(const std::string& body) const {
    return bright_ != nullptr && !bright_->contains(body);
  }

  Projection projection_;
  const Scene& scene_;
  const std::set<std::string>* bright_;
  std::vector<const SceneBox*> order_;  // far ones first
  std::map<std::string, Body> bodies_;
  LabelLayout labels_;
};

}  // namespace parallax::harness
