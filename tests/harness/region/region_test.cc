#include "harness/region/region.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "compiler/base/codes/scenarios.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

using base::DiagnosticCode;

Region region_x(std::string name, double lower, double upper, std::uint32_t begin = 0) {
  Region region;
  region.name = std::move(name);
  region.on(RegionAxis::kX) = Interval{lower, upper};
  region.source = {base::FileId(0), begin, begin + 1};
  return region;
}

Region region_xy(std::string name, Interval x, Interval y) {
  Region region;
  region.name = std::move(name);
  region.on(RegionAxis::kX) = x;
  region.on(RegionAxis::kY) = y;
  return region;
}

Region region_yaw(std::string name, double lower, double upper) {
  Region region;
  region.name = std::move(name);
  region.on(RegionAxis::kYaw) = Interval{lower, upper};
  return region;
}

RegionSet set_of(std::vector<Region> regions, bool gaps_allowed = false) {
  base::DiagnosticSink sink;
  auto set = RegionSet::make(std::move(regions), gaps_allowed, sink);
  for (const auto& diagnostic : sink.sorted()) MESSAGE(diagnostic.message);
  REQUIRE(set.has_value());
  return *set;
}

std::string located(const RegionSet& set, Point point) {
  const Region* region = set.locate(point);
  return region == nullptr ? "-" : region->name;
}

std::vector<base::Diagnostic> complaints(std::vector<Region> regions, bool gaps_allowed = false) {
  base::DiagnosticSink sink;
  CHECK_FALSE(RegionSet::make(std::move(regions), gaps_allowed, sink).has_value());
  return sink.sorted();
}

void check_one(std::vector<Region> regions, DiagnosticCode code, const std::string& message) {
  const auto found = complaints(std::move(regions));
  REQUIRE(found.size() == 1);
  CHECK(found[0].code == code);
  CHECK(found[0].message == message);
}

/// Splits a cuboid at random until `count` regions tile it; borders meet in T-junctions.
std::vector<Region> random_tiling(const CounterRng& rng, std::size_t axes, std::size_t count) {
  std::uint64_t draw = 0;
  Region whole;
  for (std::size_t a = 0; a < axes; ++a) whole.bounds[a] = Interval{-1.5, 2.25};
  std::vector<Region> regions = {whole};
  while (regions.size() < count) {
    auto& split = regions[rng.bits(draw++) % regions.size()];
    const std::size_t axis = rng.bits(draw++) % axes;
    auto& bound = *split.bounds[axis];
    // Cuts on a coarse grid, so that borders of different regions often fall together.
    const double cut = bound.lower + std::round(8 * rng.uniform(draw++)) / 8 * bound.width();
    if (cut <= bound.lower || cut >= bound.upper) continue;
    Region upper = split;
    bound.upper = cut;
    upper.bounds[axis]->lower = cut;
    regions.push_back(upper);
  }
  for (std::size_t i = 0; i < count; ++i) regions[i].name = "r" + std::to_string(i);
  return regions;
}

/// Independent oracle: the only region with the point in its interior once it was moved upwards on
/// every axis (downwards at the top of the whole cuboid) by less than any region's width.
std::string owner_by_nudging(const std::vector<Region>& regions, Point point, std::size_t axes) {
  for (std::size_t a = 0; a < axes; ++a) point[a] += point[a] == 2.25 ? -1e-9 : 1e-9;
  std::string owner = "-";
  int owners = 0;
  for (const auto& region : regions) {
    bool inside = true;
    for (std::size_t a = 0; a < axes; ++a) {
      inside = inside && point[a] > region.bounds[a]->lower && point[a] < region.bounds[a]->upper;
    }
    if (!inside) continue;
    owner = region.name;
    ++owners;
  }
  CHECK(owners == 1);
  return owner;
}

TEST_CASE("regions: a shared border belongs to the region above, the last one is closed") {
  const auto set = set_of({region_x("r1", 0, 1), region_x("r2", 1, 2)});
  CHECK(located(set, {0.0}) == "r1");
  CHECK(located(set, {std::nextafter(1.0, 0.0)}) == "r1");
  CHECK(located(set, {1.0}) == "r2");
  CHECK(located(set, {2.0}) == "r2");
  CHECK(located(set, {std::nextafter(2.0, 3.0)}) == "-");
  CHECK(located(set, {-1e-300}) == "-");
  CHECK(located(set, {std::numeric_limits<double>::quiet_NaN()}) == "-");
  CHECK_FALSE(set.find("r1")->on(RegionAxis::kX)->closed);
  CHECK(set.find("r2")->on(RegionAxis::kX)->closed);
  CHECK(set.find("r3") == nullptr);
}

TEST_CASE("regions: the order in which they are written does not matter") {
  const auto set = set_of({region_x("r2", 1, 2), region_x("r1", 0, 1)});
  CHECK(located(set, {1.0}) == "r2");
  CHECK(located(set, {0.5}) == "r1");
}

TEST_CASE("regions: with a gap allowed, both sides of it are closed where nobody takes over") {
  const auto set = set_of({region_x("a", 0, 0.9), region_x("b", 1, 2)}, true);
  CHECK(located(set, {0.9}) == "a");
  CHECK(located(set, {0.95}) == "-");
  CHECK(located(set, {1.0}) == "b");
}

TEST_CASE("regions: every point of a random tiling, borders too, belongs to exactly one region") {
  for (std::uint64_t round = 0; round < 60; ++round) {
    const CounterRng rng({.campaign_seed = 11, .sample = round});
    const std::size_t axes = 1 + round % 3;
    const auto regions = random_tiling(rng, axes, 2 + round % 9);
    const auto set = set_of(regions);
    for (std::uint64_t k = 0; k < 400; ++k) {
      // Half of the coordinates lie on some region's border.
      Point point{};
      for (std::size_t a = 0; a < axes; ++a) {
        const auto base = 1000 + 16 * k + 4 * a;
        const auto& bound = *regions[rng.bits(base) % regions.size()].bounds[a];
        point[a] = rng.uniform(base + 1) < 0.5
                       ? (rng.bits(base + 2) % 2 == 0 ? bound.lower : bound.upper)
                       : -1.5 + 3.75 * rng.uniform(base + 3);
      }
      CHECK(located(set, point) == owner_by_nudging(regions, point, axes));
    }
  }
}

TEST_CASE("regions: the closed flag of an interval agrees with the owner of the border in 1-D") {
  for (std::uint64_t round = 0; round < 40; ++round) {
    const CounterRng rng({.campaign_seed = 12, .sample = round});
    const auto set = set_of(random_tiling(rng, 1, 2 + round % 6));
    for (const auto& region : set.regions()) {
      const double end = region.on(RegionAxis::kX)->upper;
      CHECK(region.on(RegionAxis::kX)->contains(end) == (set.locate({end}) == &region));
    }
  }
}

TEST_CASE("regions: an angle is found a turn away, and the seam belongs to one side") {
  constexpr double kPi = std::numbers::pi;
  const auto set = set_of({region_yaw("south", -kPi, 0), region_yaw("north", 0, kPi)});
  CHECK(located(set, {0, 0, 0, 0.5}) == "north");
  CHECK(located(set, {0, 0, 0, 0.5 + 2 * kPi}) == "north");
  CHECK(located(set, {0, 0, 0, 0.5 - 4 * kPi}) == "north");
  CHECK(located(set, {0, 0, 0, -kPi}) == "south");
  CHECK(located(set, {0, 0, 0, kPi}) == "south");
  const auto found = complaints({region_yaw("a", -1, 1), region_yaw("b", 5, 6)}, true);
  REQUIRE(found.size() == 1);
  CHECK(found[0].code == codes::kRegionOverlap);
}

TEST_CASE("regions: half a turn with four digits still closes the circle") {
  const auto set = set_of({region_yaw("a", -3.1416, 0), region_yaw("b", 0, 3.1416)});
  CHECK(located(set, {0, 0, 0, 3.14159}) == "b");
  CHECK(located(set, {0, 0, 0, -3.14159}) == "a");
}

TEST_CASE("regions: reversed bounds are refused with the bounds the right way round") {
  const auto found = complaints({region_x("r1", 1, 0)});
  REQUIRE(found.size() == 1);
  CHECK(found[0].code == codes::kRegionReversed);
  CHECK(found[0].message == "region `r1`: the x bounds are reversed, 1 is above 0");
  CHECK(found[0].fix == "write x: [0, 1]");
}

TEST_CASE("regions: bounds without extent, without end, or missing altogether are refused") {
  check_one({region_x("r1", 1, 1)}, codes::kRegionEmpty,
            "region `r1` has no extent on x: both bounds are 1");
  check_one({region_x("r1", 0, std::numeric_limits<double>::infinity())}, codes::kRegionNotFinite,
            "region `r1`: a bound on x is not a finite number");
  check_one({region_x("r1", std::nan(""), 1)}, codes::kRegionNotFinite,
            "region `r1`: a bound on x is not a finite number");
  Region unbounded;
  unbounded.name = "r1";
  check_one({unbounded}, codes::kRegionUnbounded, "region `r1` bounds no axis");
}

TEST_CASE("regions: an overlap names both regions and points at the other one") {
  const auto found = complaints({region_x("r1", 0, 1, 10), region_x("r2", 0.9, 2, 20)});
  REQUIRE(found.size() == 1);
  CHECK(found[0].code == codes::kRegionOverlap);
  CHECK(found[0].message == "regions `r1` and `r2` overlap: x from 0.9 to 1");
  CHECK(found[0].range->begin == 20);
  REQUIRE(found[0].notes.size() == 1);
  CHECK(found[0].notes[0].range->begin == 10);
}

TEST_CASE("regions: a gap names the uncovered stretch and the regions on both sides") {
  const auto found = complaints({region_x("r2", 1, 2, 10), region_x("r1", 0, 0.9, 20)});
  REQUIRE(found.size() == 1);
  CHECK(found[0].code == codes::kRegionGap);
  CHECK(found[0].message == "no region covers x from 0.9 to 1");
  CHECK(found[0].range->begin == 20);
  REQUIRE(found[0].notes.size() == 1);
  CHECK(found[0].notes[0].text == "`r2` begins above it");
}

TEST_CASE("regions: a gap in two dimensions is a stretch on both axes") {
  check_one({region_xy("a", {0, 1}, {0, 1}), region_xy("b", {1, 2}, {0, 0.5})}, codes::kRegionGap,
            "no region covers x from 1 to 2, y from 0.5 to 1");
}

TEST_CASE("regions: mixed axes and double names are refused") {
  check_one({region_x("a", 0, 1), region_xy("b", {1, 2}, {0, 1})}, codes::kRegionMixedAxes,
            "region `b` bounds x, y, but `a` bounds x");
  check_one({region_x("a", 0, 1), region_x("a", 1, 2)}, codes::kRegionDuplicate,
            "region `a` is defined twice");
}

TEST_CASE("regions: several faults are reported in one go, and no gap that follows from them") {
  const auto found = complaints({region_x("a", 1, 0, 1), region_x("b", 2, 2, 2),
                                 region_x("c", 0, 1, 3), region_x("d", 0.5, 4, 4)});
  REQUIRE(found.size() == 3);
  CHECK(found[0].code == codes::kRegionReversed);
  CHECK(found[1].code == codes::kRegionEmpty);
  CHECK(found[2].code == codes::kRegionOverlap);
}

TEST_CASE("regions: a random tiling passes, and without one of its inner regions it has a gap") {
  for (std::uint64_t round = 0; round < 40; ++round) {
    const CounterRng rng({.campaign_seed = 13, .sample = round});
    auto regions = random_tiling(rng, 2, 9);
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const auto& x = *regions[i].on(RegionAxis::kX);
      const auto& y = *regions[i].on(RegionAxis::kY);
      // A region that is a whole side of the cuboid may leave a smaller tiling behind.
      if (x.lower == -1.5 || x.upper == 2.25 || y.lower == -1.5 || y.upper == 2.25) continue;
      auto without = regions;
      without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
      const auto found = complaints(without);
      REQUIRE(found.size() == 1);
      CHECK(found[0].code == codes::kRegionGap);
      break;
    }
  }
}

TEST_CASE("axes: names and axes are inverse") {
  for (const RegionAxis axis : kRegionAxes) CHECK(kRegionAxisWords.find(to_string(axis)) == axis);
  CHECK_FALSE(kRegionAxisWords.find("roll").has_value());
}

}  // namespace
}  // namespace parallax::harness
