#include "harness/region/region.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "compiler/base/contract.h"
#include "harness/region/area.h"

namespace parallax::harness {
namespace {

/// On which axes a region's closure has the point below its upper bound.
struct Membership {
  std::array<bool, kRegionAxes.size()> below_upper{};
  bool half_open = true;  // on all axes that the region bounds
  bool turned = false;    // an angle had to be moved by full turns
  auto rank() const {
    return std::tuple(std::count(below_upper.begin(), below_upper.end(), true), !turned,
                      below_upper);
  }
};

std::optional<bool> below_upper(const Interval& interval, double value) {
  if (value >= interval.lower && value <= interval.upper) return value < interval.upper;
  return std::nullopt;
}

/// None if the point lies outside the region's closure.
std::optional<Membership> membership(const Region& region, const Point& point) {
  Membership result;
  for (const RegionAxis axis : kRegionAxes) {
    const auto& bound = region.on(axis);
    if (!bound) continue;
    const double value = point[static_cast<std::size_t>(axis)];
    auto below = below_upper(*bound, value);
    // An angle may be reported a turn away from the bounds; unwrapping comes second, so that no
    // rounding touches a value that needs none.
    if (axis == RegionAxis::kYaw && !below.value_or(false)) {
      const auto again = below_upper(*bound, unwrapped(value, *bound));
      result.turned = again.has_value() && (!below || *again);
      if (again) below = below.value_or(false) || *again;
    }
    if (!below) return std::nullopt;
    result.below_upper[static_cast<std::size_t>(axis)] = *below;
    result.half_open = result.half_open && *below;
  }
  if (region.area && !region.area->contains({point[0], point[1]})) return std::nullopt;
  return result;
}

}  // namespace

const Region* RegionSet::find(std::string_view name) const {
  const auto found = std::find_if(regions_.begin(), regions_.end(),
                                  [&](const Region& region) { return region.name == name; });
  return found == regions_.end() ? nullptr : &*found;
}

const Region* RegionSet::locate(const Point& point, std::string_view frame) const {
  const Region* best = nullptr;
  Membership best_membership;
  for (const auto& region : regions_) {
    if (region.frame != frame) continue;
    const auto here = membership(region, point);
    if (!here) continue;
    // Regions do not overlap, so that no other one has the point in its half-open cuboid; only
    // across the seam of a circle that was closed by rounded bounds there may be two.
    if (here->half_open && !here->turned) return &region;
    // On upper faces that nobody takes over, the region that goes on above the point on most axes
    // gets it, as on any border.
    if (best == nullptr || here->rank() > best_membership.rank()) {
      best = &region;
      best_membership = *here;
    }
  }
  return best;
}

RegionMap::RegionMap(RegionSet only)
    : RegionMap([&] {
        std::vector<RegionFamily> families;
        families.push_back({{}, std::move(only), {}});
        return families;
      }()) {}

RegionMap::RegionMap(std::vector<RegionFamily> families) : families_(std::move(families)) {
  for (std::size_t i = 0; i < families_.size(); ++i) {
    for (const Region& region : families_[i].set.regions()) {
      regions_.push_back(region);
      family_.push_back(i);
    }
  }
}

const Region* RegionMap::find(std::string_view name) const {
  const auto found = std::find_if(regions_.begin(), regions_.end(),
                                  [&](const Region& region) { return region.name == name; });
  return found == regions_.end() ? nullptr : &*found;
}

const RegionFamily& RegionMap::family_of(const Region& region) const {
  const auto index = static_cast<std::size_t>(&region - regions_.data());
  PARALLAX_REQUIRE(index < regions_.size(), "a region of this map");
  return families_[family_[index]];
}

bool RegionMap::contains(const Region& region, const Point& point) const {
  const Region* owner = family_of(region).set.locate(point, region.frame);
  return owner != nullptr && owner->name == region.name;
}

bool RegionMap::answers(std::string_view function, const Region& region) const {
  const auto& functions = family_of(region).functions;
  return functions.empty() ||
         std::find(functions.begin(), functions.end(), function) != functions.end();
}

const Region* RegionMap::locate(std::string_view function, const Point& point) const {
  for (const Region& region : regions_) {
    if (region.frame.empty() && answers(function, region) && contains(region, point)) {
      return &region;
    }
  }
  return nullptr;
}

}  // namespace parallax::harness
