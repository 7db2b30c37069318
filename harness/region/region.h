#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"

namespace parallax::harness {

enum class Axis : std::uint8_t { kX, kY, kZ, kYaw };
inline constexpr std::array<Axis, 4> kAxes = {Axis::kX, Axis::kY, Axis::kZ, Axis::kYaw};
std::string_view to_string(Axis axis);            // "x", "y", "z", "yaw"
std::optional<Axis> axis_from(std::string_view);  // none for another word

/// [lower, upper) or, where `closed`, [lower, upper]; metres or radians.
struct Interval {
  double lower = 0.0;
  double upper = 0.0;
  bool closed = false;
  bool contains(double value) const {
    return value >= lower && (value < upper || (closed && value == upper));
  }
  double width() const { return upper - lower; }
  double midpoint() const { return 0.5 * (lower + upper); }
};

/// A cuboid over some of the axes; an axis that is not bounded does not matter.
struct Region {
  std::string name;
  std::array<std::optional<Interval>, 4> bounds;  // by Axis
  base::SourceRange source;
  const std::optional<Interval>& on(Axis axis) const {
    return bounds[static_cast<std::size_t>(axis)];
  }
  std::optional<Interval>& on(Axis axis) { return bounds[static_cast<std::size_t>(axis)]; }
};

/// Disjoint regions. A value on a shared border belongs to the region above it; an upper bound
/// that no other region takes over is closed, so that every point of the union belongs to exactly
/// one region (the paper's r1 and r2 both own x = 1, which is no function).
class RegionSet {
 public:
  /// Reports reversed or empty bounds, non-finite bounds, overlaps (naming both), different sets
  /// of axes, and, unless `gaps_allowed`, cells that do not tile their bounding cuboid, with the
  /// first uncovered stretch. `regions` in source order.
  static base::Result<RegionSet> make(std::vector<Region> regions, bool gaps_allowed,
                                      base::DiagnosticSink& sink);
  const std::vector<Region>& regions() const { return regions_; }
  const Region* find(std::string_view name) const;
  /// The region that contains the point; axes the set does not bound are ignored. None: outside.
  const Region* locate(const std::array<double, 4>& point) const;

 private:
  std::vector<Region> regions_;
};

}  // namespace parallax::harness
