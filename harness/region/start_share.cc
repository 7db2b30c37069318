#include "harness/region/start_share.h"

#include <algorithm>
#include <cstdint>
#include <tuple>

namespace parallax::harness {
namespace {

const Interval* find(const StartCuboid& start, const std::string& variable) {
  const auto found =
      std::find_if(start.dimensions.begin(), start.dimensions.end(),
                   [&](const SampledDimension& one) { return one.variable == variable; });
  return found == start.dimensions.end() ? nullptr : &found->interval;
}

/// The quotient of two shares, counted on a grid: the share of the start cuboid's rectangle over x
/// and y that is drawn from, over the share of the cell's rectangle that is in the cell.
double share_of_shape(const Region& region, const StartCuboid& start, const std::string& body) {
  constexpr int kSteps = 400;
  const auto part = [&](const Interval& x, const Interval& y, bool of_start) {
    std::int64_t inside = 0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        PlanePoint point = {x.lower + x.width() * (i + 0.5) / kSteps,
                            y.lower + y.width() * (j + 0.5) / kSteps};
        bool in = !region.area || region.area->contains(point);
        if (of_start && region.start_area) in = in && region.start_area->contains(point);
        inside += in ? 1 : 0;
      }
    }
    return static_cast<double>(inside);
  };
  const auto &x = region.on(RegionAxis::kX), &y = region.on(RegionAxis::kY);
  const auto* drawn_x = find(start, body + ".x");
  const auto* drawn_y = find(start, body + ".y");
  if (!x || !y || drawn_x == nullptr || drawn_y == nullptr) return 1.0;
  const auto local = [&](Interval range, std::size_t axis) {
    range.lower -= region.frame_start[axis];
    range.upper -= region.frame_start[axis];
    return range;
  };
  const double whole = part(*x, *y, false);
  return whole > 0.0 ? part(local(*drawn_x, 0), local(*drawn_y, 1), true) / whole : 1.0;
}

StartShare share_of(const std::string& body, const Region& region, const StartCuboid& start) {
  StartShare result;
  result.body = body;
  result.region = region.name;
  for (const RegionAxis axis : kRegionAxes) {
    const auto& whole = region.on(axis);
    if (!whole) continue;
    const std::string name(to_string(axis));
    const Interval* drawn = find(start, body + "." + name);
    if (drawn == nullptr || drawn->lower == drawn->upper) {
      result.fixed.push_back(name);
      continue;
    }
    result.axes.push_back({name, drawn->width(), whole->width()});
    result.share *= drawn->width() / whole->width();
  }
  if (region.area || region.start_area) result.share *= share_of_shape(region, start, body);
  return result;
}

}  // namespace

std::vector<StartShare> start_shares(const StateMapping& mapping,
                                     const std::set<std::string>& true_fluents, StartCuboid start,
                                     double inset) {
  for (auto& [variable, interval] : start.dimensions) {
    if (interval.lower == interval.upper) continue;
    interval.lower += inset;
    interval.upper -= inset;
  }
  std::vector<StartShare> shares;
  for (const std::string& text : true_fluents) {
    const GroundFluent fluent = ground_fluent(text);
    const FluentBinding* binding = mapping.find(fluent.symbol);
    const auto* inside = binding == nullptr ? nullptr : binding->inside();
    if (inside == nullptr || !inside->drawn) continue;
    const Region* region = inside->region_of(fluent, mapping.regions());
    if (region == nullptr) continue;
    shares.push_back(share_of(with_arguments(inside->body, fluent), *region, start));
  }
  std::sort(shares.begin(), shares.end(), [](const StartShare& a, const StartShare& b) {
    return std::tie(a.body, a.region) < std::tie(b.body, b.region);
  });
  return shares;
}

}  // namespace parallax::harness
