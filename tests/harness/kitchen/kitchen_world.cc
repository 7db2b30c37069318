#include "tests/harness/kitchen/kitchen_world.h"

#include <doctest/doctest.h>

#include "tests/harness/config/scenario_world.h"

namespace parallax::harness {

const WorldSpec& kitchen_world() {
  static const WorldSpec world = world_of("kitchen/plan2.yaml");
  return world;
}

void Kitchen::start(const State& initial) {
  const Outcome outcome = simulator_.reset(initial, 1);
  CAPTURE(outcome.reason);
  REQUIRE(outcome.status == SimStatus::kOk);
}

Outcome Kitchen::act(std::string_view controller, const State& arguments) {
  const Outcome outcome = simulator_.act(controller, arguments, 60.0);
  REQUIRE(outcome.status != SimStatus::kUnsupported);
  REQUIRE(outcome.status != SimStatus::kLost);
  return outcome;
}

Outcome Kitchen::pick(const std::string& item) {
  return act("pick-up", {{"arm", std::string("left")}, {"object", item}});
}

Outcome Kitchen::lift_milk() {
  REQUIRE(ok(look("pw1")));
  REQUIRE(ok(detect("milk")));
  return pick("milk1");
}

void Kitchen::carry_milk() {
  REQUIRE(ok(lift_milk()));
  REQUIRE(ok(park()));
  REQUIRE(ok(drive("bTable")));
}

Outcome Kitchen::move(std::string_view controller, const std::string& drawer) {
  return act(controller, {{"arm", std::string("left")}, {"joint", drawer}});
}

double Kitchen::number(std::string_view name) {
  const State state = simulator_.state();
  return std::get<double>(state.find(name)->second);
}

std::string Kitchen::text(std::string_view name) {
  const State state = simulator_.state();
  return std::get<std::string>(state.find(name)->second);
}

bool Kitchen::flag(std::string_view name) {
  const State state = simulator_.state();
  return std::get<bool>(state.find(name)->second);
}

bool ok(const Outcome& outcome) { return outcome.status == SimStatus::kOk; }

}  // namespace parallax::harness
