#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace parallax::harness {

using PlanePoint = std::array<double, 2>;  // x, y [m]

/// The area between two circles; a disc where `inner_m` is 0.
struct RingShape {
  PlanePoint at{};
  double inner_m = 0.0, outer_m = 0.0;
};

/// A polygon with its corners in either sense, which does not cross or touch itself.
struct PolygonShape {
  std::vector<PlanePoint> corners;
};

using PlaneShape = std::variant<RingShape, PolygonShape>;

/// Explains why the shape is invalid: "goes through (1, 0) twice"; empty: it is valid. Numbers are
/// finite.
std::string fault_of(const PlaneShape& shape);

/// A part of the floor plan that need not be a rectangle: the union of shapes, which may overlap.
/// With a height range beside it a disc is a cylinder, a polygon a prism.
class Area {
 public:
  /// The shapes must be free of faults, and there must be at least one.
  explicit Area(std::vector<PlaneShape> shapes);

  bool contains(const PlanePoint& point) const;
  /// [m] from the border, positive inside. Within an overlap of shapes the deepest counts, so it is
  /// a lower bound there.
  double signed_distance_m(const PlanePoint& point) const;
  /// The least rectangle around it: lower and upper corner.
  std::pair<PlanePoint, PlanePoint> bounds() const;

  /// Takes the unit square to the area so that equal parts of the square go to equal parts of the
  /// area: a uniform pair becomes a uniform point. A pair whose point another shape answers for has
  /// none; what is left is uniform in the union. `u`, `v` in [0, 1).
  std::optional<PlanePoint> at(double u, double v) const;

  /// The sum over its shapes, whose overlaps count more than once [m^2].
  double total_size_m2() const { return cumulative_.back(); }
  /// "a disc of 0.1 m around (1, 0)"; `offset` is added to its places.
  std::string text(const PlanePoint& offset = {}) const;

 private:
  struct Triangle {
    std::array<PlanePoint, 3> corners;
    double size_m2 = 0.0;
  };
  struct Part {
    PlaneShape shape;
    std::vector<Triangle> triangles;  // of a polygon
  };
  std::vector<Part> parts_;
  std::vector<double> cumulative_;  // of the parts' sizes
};

}  // namespace parallax::harness
