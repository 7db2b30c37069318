#include <algorithm>

#include "compiler/base/contract.h"
#include "harness/region/region.h"

namespace parallax::harness {

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
