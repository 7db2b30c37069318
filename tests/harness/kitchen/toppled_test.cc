#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>

#include "tests/harness/config/scenario_world.h"
#include "tests/harness/kitchen/kitchen_world.h"

namespace parallax::harness {
namespace {

TEST_CASE("a carton that has toppled is not placed, where orientation is asked for") {
  const Scenario scenario = scenario_of("kitchen/plan2.yaml");
  const FluentBinding* strict = scenario.mapping->find("ItemAt");
  REQUIRE(strict != nullptr);
  FluentBinding lax = *strict;
  std::get<InsideBinding>(lax.condition).upright.reset();
  const auto reading = [&](const FluentBinding& binding, const char* fluent, const State& state) {
    return binding.read(ground_fluent(fluent), state, scenario.mapping->regions(), nullptr);
  };

  // A carton on a narrow foot, its weight beside it: it topples by itself, to the left.
  WorldSpec spec = scenario.world;
  BodySpec& milk = body_of(spec, "milk1");
  milk.shapes = {BodyShape{{0.06, 0.02, 0.10}, {0.0, 0.0, -0.05}},
                 BodyShape{{0.06, 0.08, 0.06}, {0.0, 0.04, 0.03}}};
  Kitchen kitchen(spec);
  kitchen.start({{"milk1.y", 0.03}, {"milk1.bottom", 0.85}, {"cereal1.y", 0.23}});
  CHECK(reading(*strict, "ItemAt(milk1,pw1)", kitchen.simulator().state()) == Reading::kHolds);
  for (int i = 0; i < 10; ++i)
    REQUIRE(ok(kitchen.act("look", {{"place", std::string("pw1")}, {"settle_s", 0.3}})));
  const State state = kitchen.simulator().state();
  CAPTURE(kitchen.number("milk1.y"));
  CHECK(std::abs(kitchen.number("milk1.roll")) > 0.9);
  CHECK(reading(lax, "ItemAt(milk1,pw1)", state) == Reading::kHolds);
  CHECK(reading(*strict, "ItemAt(milk1,pw1)", state) == Reading::kFails);
}

}  // namespace
}  // namespace parallax::harness
