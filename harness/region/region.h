#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/word_table.h"

namespace parallax::harness {

/// kBottom is the height of a body's lowest point.
enum class RegionAxis : std::uint8_t { kX, kY, kZ, kYaw, kBottom };
inline constexpr std::array<RegionAxis, 5> kRegionAxes = {
    RegionAxis::kX, RegionAxis::kY, RegionAxis::kZ, RegionAxis::kYaw, RegionAxis::kBottom};
using Point = std::array<double, kRegionAxes.size()>;  // by RegionAxis
inline constexpr auto kRegionAxisWords =
    base::word_table<RegionAxis>("x", "y", "z", "yaw", "bottom");
constexpr std::string_view to_string(RegionAxis axis) { return kRegionAxisWords.of(axis); }

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

class Area;

/// A cuboid over some of the axes; an axis that is not bounded does not matter. With an `area` only
/// that part of it whose x and y lie there.
struct Region {
  std::string name;
  std::array<std::optional<Interval>, kRegionAxes.size()> bounds;  // by RegionAxis
  base::SourceRange source;
  /// The ranges that starts are drawn from, on axes where they are narrower than the bounds.
  std::array<std::optional<Interval>, kRegionAxes.size()> start;
  std::shared_ptr<const Area> area{}, start_area{};
  /// Body in whose frame the bounds are; empty: the world. `frame_start` is where it is at a reset
  /// (no turn).
  std::string frame;
  std::array<double, 3> frame_start{};
  const std::optional<Interval>& on(RegionAxis axis) const {
    return bounds[static_cast<std::size_t>(axis)];
  }
  std::optional<Interval>& on(RegionAxis axis) { return bounds[static_cast<std::size_t>(axis)]; }
};

/// Disjoint regions. A value on a shared border belongs to the region above it; an upper bound
/// that no other region takes over is closed, so that every point of the union belongs to exactly
/// one region (the paper's r1 and r2 both own x = 1, which is no function). Regions with an area
/// must be disjoint as cuboids, too, and need `gaps_allowed`.
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
  /// Regions of another frame do not count.
  const Region* locate(const Point& point, std::string_view frame = {}) const;

 private:
  std::vector<Region> regions_;
};

/// A family of regions, and the functions of a plan's binding table that ask for it; all if empty.
struct RegionFamily {
  std::string name;
  RegionSet set;
  std::vector<std::string> functions;  // "region", "place", "gaze"
};

/// All regions of a scenario. Those of one family and one frame are disjoint; families are about
/// different things (where robots stand, where items lie), and their regions may overlap.
class RegionMap {
 public:
  RegionMap(RegionSet only);  // NOLINT(google-explicit-constructor): one family is a map, too
  explicit RegionMap(std::vector<RegionFamily> families);

  /// All regions, family by family.
  const std::vector<Region>& regions() const { return regions_; }
  const Region* find(std::string_view name) const;
  /// Does the point, in the frame of `region` (one of regions()), belong to it?
  bool contains(const Region& region, const Point& point) const;
  /// The region in the frame of the world that `function` of a plan finds for a point.
  const Region* locate(std::string_view function, const Point& point) const;
  /// Is the region one that `function` asks for?
  bool answers(std::string_view function, const Region& region) const;

 private:
  const RegionFamily& family_of(const Region& region) const;
  std::vector<RegionFamily> families_;
  std::vector<Region> regions_;
  std::vector<std::size_t> family_;  // by region
};

}  // namespace parallax::harness
