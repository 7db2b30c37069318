#include "harness/region/start_share.h"

#include <algorithm>
#include <tuple>

namespace parallax::harness {
namespace {

const Interval* find(const StartCuboid& start, const std::string& variable) {
  const auto found =
      std::find_if(start.dimensions.begin(), start.dimensions.end(),
                   [&](const SampledDimension& one) { return one.variable == variable; });
  return found == start.dimensions.end() ? nullptr : &found->interval;
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
  return result;
}

}  // namespace

std::vector<StartShare> start_shares(const StateMapping& mapping,
                                     const std::set<std::string>& true_fluents,
                                     const StartCuboid& start) {
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
