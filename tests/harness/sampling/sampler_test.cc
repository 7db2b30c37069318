#include "harness/sampling/sampler.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace parallax::harness {
namespace {

double real(const State& state, const std::string& variable) {
  return std::get<double>(state.at(variable));
}

Sampler sampler_of(StartCuboid cuboid, double inset = Sampler::kDefaultInset) {
  base::DiagnosticSink sink;
  auto sampler = Sampler::make(std::move(cuboid), inset, {}, sink);
  REQUIRE(sampler.has_value());
  return *sampler;
}

/// Two bodies over a random grid of regions on x, y and yaw; the flag excludes a held body.
StateMapping random_grid(const CounterRng& rng) {
  std::uint64_t draw = 0;
  const auto cuts = [&](double low, double high) {
    std::vector<double> result = {low, high};
    for (int i = 0; i < 3; ++i) result.push_back(low + (high - low) * rng.uniform(draw++));
    std::sort(result.begin(), result.end());
    return result;
  };
  const auto x = cuts(-1000.0 * rng.uniform(draw++), 3.0);
  const auto y = cuts(0.0, 1e-3 + rng.uniform(draw++));
  const auto yaw = cuts(-3.0, 3.0);
  std::vector<Region> regions;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    for (std::size_t j = 0; j + 1 < y.size(); ++j) {
      for (std::size_t k = 0; k + 1 < yaw.size(); ++k) {
        Region region;
        region.name = "r" + std::to_string(regions.size());
        region.on(RegionAxis::kX) = Interval{x[i], x[i + 1]};
        region.on(RegionAxis::kY) = Interval{y[j], y[j + 1]};
        region.on(RegionAxis::kYaw) = Interval{yaw[k], yaw[k + 1]};
        regions.push_back(region);
      }
    }
  }
  base::DiagnosticSink sink;
  auto set = RegionSet::make(std::move(regions), false, sink);
  REQUIRE(set.has_value());
  return StateMapping(*set, {{"In", 2, InsideBinding{"{0}", 1, "{0}.held", {}}, {}},
                             {"Held", 1, FlagBinding{"{0}.held"}, {}}});
}

TEST_CASE("sampler: every start that is drawn for a discrete state maps back to it") {
  for (const double inset : {0.0, 1e-9}) {
    for (std::uint64_t round = 0; round < 40; ++round) {
      const CounterRng rng({.campaign_seed = 3, .sample = round});
      const auto mapping = random_grid(rng);
      std::vector<GroundFluent> fluents;
      for (const std::string body : {"cup", "robot"}) {
        for (const auto& region : mapping.regions().regions()) {
          fluents.push_back(ground_fluent("In(" + body + "," + region.name + ")"));
        }
        fluents.push_back(ground_fluent("Held(" + body + ")"));
      }
      const auto& regions = mapping.regions().regions();
      const auto pick = [&](std::uint64_t k) { return regions[rng.bits(k) % regions.size()].name; };
      const std::set<std::string> start = {"In(cup," + pick(900) + ")",
                                           "In(robot," + pick(901) + ")"};
      base::DiagnosticSink sink;
      auto cuboid = mapping.start_cuboid(fluents, start, {}, {}, sink);
      REQUIRE(cuboid.has_value());
      REQUIRE(cuboid->dimensions.size() == 6);
      const auto sampler = sampler_of(*cuboid, inset);
      for (std::uint64_t sample = 0; sample < 100; ++sample) {
        const auto state = sampler.draw({.campaign_seed = 4, .trace_key = round, .sample = sample});
        CHECK(mapping.wrong_at_start(fluents, start, state).empty());
      }
      // The check itself can fail: another region's centre is not this region.
      auto moved = sampler.draw({});
      moved["cup.x"] = std::get<double>(moved["cup.x"]) + 2000.0;
      CHECK(mapping.wrong_at_start(fluents, start, moved).size() == 1);
    }
  }
}

TEST_CASE("sampler: draws stay clear of the borders by the inset and reach close to them") {
  const double inset = 0.01;
  const auto sampler = sampler_of({{{"a", {1.0, 2.0}}}}, inset);
  double least = 2.0, greatest = 1.0;
  for (std::uint64_t sample = 0; sample < 5000; ++sample) {
    const double value = real(sampler.draw({.sample = sample}), "a");
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
  CHECK(least >= 1.0 + inset);
  CHECK(greatest < 2.0 - inset);
  // (1 - 0.004)^5000 = 2e-9 for each side.
  CHECK(least < 1.014);
  CHECK(greatest > 1.986);
}

TEST_CASE("sampler: rounding never reaches the upper end of a narrow interval") {
  const double lower = 1.0, upper = 1.0 + 4 * 0x1.0p-52;
  const auto sampler = sampler_of({{{"a", {lower, upper}}}}, 0.0);
  for (std::uint64_t sample = 0; sample < 2000; ++sample) {
    const double value = real(sampler.draw({.sample = sample}), "a");
    CHECK(value >= lower);
    CHECK(value < upper);
  }
}

TEST_CASE("sampler: fixed dimensions stay, and do not shift the values of the others") {
  const auto with = sampler_of({{{"a", {0.5, 0.5}}, {"b", {0.0, 1.0}}}}, 0.0);
  const auto varying = sampler_of({{{"a", {0.0, 1.0}}, {"b", {0.0, 1.0}}}}, 0.0);
  const DrawKey key{.campaign_seed = 1, .sample = 5};
  CHECK(real(with.draw(key), "a") == 0.5);
  CHECK(real(with.draw(key), "b") == real(varying.draw(key), "b"));
  CHECK(real(varying.draw(key), "a") == CounterRng(key).uniform(0));
}

TEST_CASE("sampler: an inset that eats up an interval is refused, each dimension by name") {
  base::DiagnosticSink sink;
  CHECK_FALSE(Sampler::make({{{"a", {0, 0.02}}, {"b", {0, 1}}, {"c", {0, 0.001}}, {"d", {1, 1}}}},
                            0.01, {base::FileId(0), 0, 1}, sink)
                  .has_value());
  const auto found = sink.sorted();
  REQUIRE(found.size() == 2);
  CHECK(found[0].message ==
        "cannot draw `a` from 0 to 0.02 with a distance of 0.01 from both ends");
  CHECK(found[1].message ==
        "cannot draw `c` from 0 to 0.001 with a distance of 0.01 from both ends");
}

}  // namespace
}  // namespace parallax::harness
