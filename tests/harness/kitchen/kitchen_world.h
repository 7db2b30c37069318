#pragma once

#include <string>
#include <string_view>

#include "harness/config/scenario.h"
#include "harness/robot/ode_simulator.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {

/// The world of scenarios/kitchen, as the scenario files say.
const WorldSpec& kitchen_world();

/// Short names for the actions of the plans. Every action is allowed 60 s.
class Kitchen {
 public:
  explicit Kitchen(const WorldSpec& spec) : simulator_(spec) {}

  /// Must succeed.
  void start(const State& initial);
  Outcome act(std::string_view controller, const State& arguments);
  Outcome open(const std::string& drawer) { return move("open-drawer", drawer); }
  Outcome close(const std::string& drawer) { return move("close-drawer", drawer); }
  Outcome look(const std::string& place) { return act("look", {{"place", place}}); }
  Outcome detect(const std::string& kind) { return act("detect", {{"kind", kind}}); }
  Outcome pick(const std::string& item);
  Outcome park() { return act("park", {{"arm", std::string("left")}}); }
  Outcome drive(const std::string& place) { return act("drive", {{"place", place}}); }
  /// Finds the milk on the counter, which must succeed, and picks it up.
  Outcome lift_milk();
  /// Lifts the milk, parks the arm and drives to the table. All must succeed.
  void carry_milk();

  double number(std::string_view name);
  bool flag(std::string_view name);
  std::string text(std::string_view name);
  OdeSimulator& simulator() { return simulator_; }

 private:
  Outcome move(std::string_view controller, const std::string& drawer);
  OdeSimulator simulator_;
};

bool ok(const Outcome& outcome);

}  // namespace parallax::harness
