#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/base/codes/scenarios.h"
#include "harness/region/angle_range.h"
#include "harness/region/region.h"

namespace parallax::harness {
namespace {

using base::DiagnosticSink;

constexpr double kTurn = 2.0 * std::numbers::pi;
/// Half a turn written with four digits (3.142) still closes the circle [rad].
constexpr double kSeamRad = 1e-3;

std::string stretch(RegionAxis axis, double lower, double upper) {
  return fmt::format("{} from {} to {}", to_string(axis), lower, upper);
}

std::string axes_of(const Region& region) {
  std::vector<std::string_view> names;
  for (const RegionAxis axis : kRegionAxes) {
    if (region.on(axis)) names.push_back(to_string(axis));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Reports what is wrong with one region alone; true if nothing is.
bool check_bounds(const Region& region, DiagnosticSink& sink) {
  bool good = true, bounded = false;
  for (const RegionAxis axis : kRegionAxes) {
    const auto& bound = region.on(axis);
    if (!bound) continue;
    bounded = true;
    const auto name = to_string(axis);
    if (!std::isfinite(bound->lower) || !std::isfinite(bound->upper)) {
      sink.error(codes::kRegionNotFinite, region.source, region.name, name);
    } else if (bound->lower > bound->upper) {
      sink.error(codes::kRegionReversed, region.source, region.name, name, bound->lower,
                 bound->upper)
          .fix(fmt::format("write {}: [{}, {}]", name, bound->upper, bound->lower));
    } else if (bound->lower == bound->upper) {
      sink.error(codes::kRegionEmpty, region.source, region.name, name, bound->lower);
    } else if (const auto fault = axis == RegionAxis::kYaw ? angle_fault(*bound) : std::nullopt) {
      sink.error(codes::kRegionAngle, region.source, region.name, *fault);
    } else {
      continue;
    }
    good = false;
  }
  if (!bounded) sink.error(codes::kRegionUnbounded, region.source, region.name);
  return good && bounded;
}

/// The stretch that two intervals share, if it has a length. Angles also meet across the seam.
std::optional<Interval> shared(RegionAxis axis, const Interval& a, const Interval& b) {
  for (const double turn : {0.0, kTurn, -kTurn}) {
    if (turn != 0.0 && axis != RegionAxis::kYaw) break;
    const double slack = turn == 0.0 ? 0.0 : kSeamRad;
    const Interval both{std::max(a.lower, b.lower + turn), std::min(a.upper, b.upper + turn)};
    if (both.lower + slack < both.upper) return both;
  }
  return std::nullopt;
}

/// The cuboid that two regions over the same axes share, as text; empty if they do not overlap.
std::string overlap(const Region& a, const Region& b) {
  if (a.frame != b.frame) return {};
  std::vector<std::string> parts;
  for (const RegionAxis axis : kRegionAxes) {
    if (!a.on(axis)) continue;
    const auto both = shared(axis, *a.on(axis), *b.on(axis));
    if (!both) return {};
    parts.push_back(stretch(axis, both->lower, both->upper));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Does `other` go on where `region` ends on `axis`?
bool takes_over(const Region& other, const Region& region, RegionAxis axis) {
  if (other.frame != region.frame) return false;
  for (const RegionAxis each : kRegionAxes) {
    if (!region.on(each)) continue;
    if (each != axis) {
      if (!shared(each, *region.on(each), *other.on(each))) return false;
      continue;
    }
    const double gap = other.on(axis)->lower - region.on(axis)->upper;
    const bool seam = axis == RegionAxis::kYaw && std::abs(gap + kTurn) <= kSeamRad;
    if (gap != 0.0 && !seam) return false;
  }
  return true;
}

/// Looks for a part of the bounding cuboid that no region covers.
class GapSearch {
 public:
  explicit GapSearch(const std::vector<Region>& regions) : regions_(regions) {
    for (const RegionAxis axis : kRegionAxes) {
      if (regions.front().on(axis)) axes_.push_back(axis);
    }
  }

  /// "x from 0.9 to 1", axis by axis; none if the regions tile their bounding cuboid.
  std::optional<std::string> first() {
    std::vector<const Region*> all;
    for (const auto& region : regions_) all.push_back(&region);
    if (!descend(0, all)) return std::nullopt;
    return fmt::format("{}", fmt::join(path_, ", "));
  }
  /// Where the gap begins on the first axis.
  double begin() const { return begin_; }
  RegionAxis first_axis() const { return axes_.front(); }

 private:
  std::vector<double> cuts(RegionAxis axis, const std::vector<const Region*>& slab) const {
    std::vector<double> result;
    const auto by_lower = [&](const Region& a, const Region& b) {
      return a.on(axis)->lower < b.on(axis)->lower;
    };
    const auto by_upper = [&](const Region& a, const Region& b) {
      return a.on(axis)->upper < b.on(axis)->upper;
    };
    result.push_back(std::min_element(regions_.begin(), regions_.end(), by_lower)->on(axis)->lower);
    result.push_back(std::max_element(regions_.begin(), regions_.end(), by_upper)->on(axis)->upper);
    for (const auto* region : slab) {
      result.push_back(region->on(axis)->lower);
      result.push_back(region->on(axis)->upper);
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  /// Cuts the slab of `candidates` along axis `depth`; between two neighbouring cuts a region
  /// either spans everything or nothing.
  bool descend(std::size_t depth, const std::vector<const Region*>& candidates) {
    if (depth == axes_.size()) return candidates.empty();
    const RegionAxis axis = axes_[depth];
    const auto ends = cuts(axis, candidates);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      std::vector<const Region*> inside;
      for (const auto* region : candidates) {
        if (region->on(axis)->lower <= ends[i] && region->on(axis)->upper >= ends[i + 1]) {
          inside.push_back(region);
        }
      }
      path_.push_back(stretch(axis, ends[i], ends[i + 1]));
      if (depth == 0) begin_ = ends[i];
      // An empty slab is a gap over its whole cross-section: further axes would add nothing.
      if (inside.empty() || descend(depth + 1, inside)) return true;
      path_.pop_back();
    }
    return false;
  }

  const std::vector<Region>& regions_;
  std::vector<RegionAxis> axes_;
  std::vector<std::string> path_;
  double begin_ = 0.0;
};

void report_gap(const std::vector<Region>& regions, DiagnosticSink& sink) {
  GapSearch search(regions);
  const auto gap = search.first();
  if (!gap) return;
  // Blame the region below the gap, which ends too early, or, if there is none, the first.
  const auto below = std::find_if(regions.begin(), regions.end(), [&](const Region& region) {
    return region.on(search.first_axis())->upper == search.begin();
  });
  const Region& blamed = below == regions.end() ? regions.front() : *below;
  auto report = sink.error(codes::kRegionGap, blamed.source, *gap);
  const Region* next = nullptr;
  for (const auto& region : regions) {
    const double lower = region.on(search.first_axis())->lower;
    if (lower <= search.begin() || &region == &blamed) continue;
    if (next == nullptr || lower < next->on(search.first_axis())->lower) next = &region;
  }
  if (next != nullptr) report.note(next->source, fmt::format("`{}` begins above it", next->name));
}

bool same_axes(const Region& a, const Region& b) {
  return std::all_of(kRegionAxes.begin(), kRegionAxes.end(), [&](RegionAxis axis) {
    return a.on(axis).has_value() == b.on(axis).has_value();
  });
}

/// Names and axes against the regions before; returns those that can be compared as cuboids.
std::vector<Region> check_each(const std::vector<Region>& regions, DiagnosticSink& sink) {
  std::vector<Region> good;
  for (const auto& region : regions) {
    const auto twin = std::find_if(regions.data(), &region,
                                   [&](const Region& other) { return other.name == region.name; });
    if (twin != &region) {
      sink.error(codes::kRegionDuplicate, region.source, region.name)
          .note(twin->source, "the first definition is here");
      continue;
    }
    if (!check_bounds(region, sink)) continue;
    if (!good.empty() && !same_axes(region, good.front())) {
      sink.error(codes::kRegionMixedAxes, region.source, region.name, axes_of(region),
                 good.front().name, axes_of(good.front()))
          .note(good.front().source, fmt::format("`{}` is here", good.front().name));
      continue;
    }
    good.push_back(region);
  }
  return good;
}

}  // namespace

base::Result<RegionSet> RegionSet::make(std::vector<Region> regions, bool gaps_allowed,
                                        base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  auto good = check_each(regions, sink);
  for (std::size_t j = 0; j < good.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      const auto text = overlap(good[i], good[j]);
      if (text.empty()) continue;
      sink.error(codes::kRegionOverlap, good[j].source, good[i].name, good[j].name, text)
          .note(good[i].source, fmt::format("`{}` is here", good[i].name));
    }
  }
  // A gap beside a region that was refused would be reported twice.
  if (sink.error_count() == errors_before && !gaps_allowed && !good.empty()) {
    const auto shaped = std::find_if(good.begin(), good.end(),
                                     [](const Region& region) { return region.area != nullptr; });
    if (shaped == good.end()) {
      report_gap(good, sink);
    } else {
      sink.error(codes::kRegionGap, shaped->source,
                 fmt::format("what is around the shape of `{}`", shaped->name));
    }
  }
  if (sink.error_count() != errors_before) return sink.already_reported();

  RegionSet result;
  result.regions_ = std::move(regions);
  for (auto& region : result.regions_) {
    for (const RegionAxis axis : kRegionAxes) {
      if (!region.on(axis)) continue;
      region.on(axis)->closed =
          std::none_of(result.regions_.begin(), result.regions_.end(),
                       [&](const Region& other) { return takes_over(other, region, axis); });
    }
  }
  return result;
}

}  // namespace parallax::harness
