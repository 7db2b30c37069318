#include "tests/harness/kitchen/kitchen_world.h"

#include <doctest/doctest.h>

#include <algorithm>

namespace parallax::harness {

const WorldSpec& kitchen_world() {
  static const WorldSpec world = [] {
    base::SourceFiles files;
    base::DiagnosticSink sink;
    const auto scenario =
        load_scenario(PARALLAX_SOURCE_DIR "/scenarios/kitchen/plan2.yaml", files, sink);
    REQUIRE(scenario.has_value());
    return scenario->world;
  }();
  return world;
}

BodySpec& body_of(WorldSpec& spec, std::string_view name) {
  return *std::find_if(spec.bodies.begin(), spec.bodies.end(),
                       [&](const BodySpec& body) { return body.name == name; });
}

JointSpec& joint_of(WorldSpec& spec, std::string_view name) {
  return *std::find_if(spec.joints.begin(), spec.joints.end(),
                       [&](const JointSpec& joint) { return joint.name == name; });
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
