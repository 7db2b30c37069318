#include "harness/robot/controller.h"

#include <doctest/doctest.h>

#include "harness/engine/ode_world.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

TEST_CASE("every controller of the table can be made, and no other") {
  for (const ControllerSpec& spec : controllers()) {
    CAPTURE(spec.name);
    CHECK((find_factory(spec.name) != nullptr));
  }
  CHECK((find_factory("flying") == nullptr));
}

TEST_CASE("steps in a row are counted from the last that was otherwise") {
  StepsInARow steps;
  CHECK(steps.note(true) == 1);
  CHECK(steps.note(true) == 2);
  CHECK(steps.note(false) == 0);
  CHECK(steps.note(true) == 1);
}

/// Phases as a test adds them; the judgement repeats what was overdue.
class Script final : public PhasedController {
 public:
  using PhasedController::add;
  using PhasedController::add_pause;
  using PhasedController::add_step;
  using PhasedController::refuse;
  using PhasedController::with_overdue;
  explicit Script(const ControlContext& context) : PhasedController(context) {}

 private:
  Outcome judge(std::string_view overdue) override {
    return {SimStatus::kOk, std::string(overdue), 0.0, {}};
  }
};

struct Stage {
  WorldSpec spec;
  OdeWorld world{spec};
  GraspMonitor grasp{spec, world};
  Script script{ControlContext{spec, world, grasp}};
  std::string log;

  /// A phase that writes down when it begins and lasts for `ticks` more of them.
  void add(char name, int ticks, double limit_s = 100.0) {
    static constexpr std::string_view kNames = "abcdefg";
    script.add(
        kNames.substr(static_cast<std::size_t>(name - 'a'), 1),
        [this, name, limit_s] {
          log += name;
          return limit_s;
        },
        [left = ticks]() mutable { return left-- <= 0; });
  }
  /// Ticks, a second each, until the end; the number of seconds.
  int run(Outcome& outcome) {
    for (int second = 0;; ++second) {
      if (const auto end = script.tick(second)) {
        outcome = *end;
        return second;
      }
      log += '.';
    }
  }
};

TEST_CASE("phases follow each other, without a timestep between them") {
  Stage stage;
  stage.add('a', 2);
  stage.add('b', 0);
  stage.add('c', 1);
  Outcome outcome;
  CHECK(stage.run(outcome) == 3);
  CHECK(stage.log == "a..bc.");
  CHECK(outcome.reason.empty());
}

TEST_CASE("the first phase that meets its limit is remembered, and the rest go on") {
  Stage stage;
  stage.add('a', 1);
  stage.add('b', 50, 2.0);
  stage.add('c', 50, 1.0);
  Outcome outcome;
  CHECK(stage.run(outcome) == 4);
  CHECK(stage.log == "a.b..c.");
  CHECK(outcome.reason == "b");
  CHECK(Script::with_overdue("it fell", outcome.reason) == "it fell (b did not come to its end)");
  CHECK(Script::with_overdue("it fell", "") == "it fell");
}

TEST_CASE("what a phase adds while it begins comes right behind it, in order") {
  Stage stage;
  stage.script.add_step([&stage] {
    stage.log += '!';
    stage.add('b', 0);
    stage.add('c', 1);
  });
  stage.add('d', 0);
  Outcome outcome;
  stage.run(outcome);
  CHECK(stage.log == "!bc.d");
}

TEST_CASE("a refusal skips all that is left") {
  Stage stage;
  stage.add('a', 1);
  stage.script.add_step([&stage] { stage.script.refuse("no way", {{"reach", -0.1}}); });
  stage.add('b', 1);
  Outcome outcome;
  CHECK(stage.run(outcome) == 1);
  CHECK(stage.log == "a.");
  CHECK(outcome.status == SimStatus::kFailed);
  CHECK(outcome.reason == "no way");
  CHECK(outcome.margins == State{{"reach", -0.1}});
}

TEST_CASE("a pause lasts for its time in steps of the world, and is never overdue") {
  Stage stage;
  stage.script.add_pause("settling", 0.01);
  int ticks = 0;
  std::optional<Outcome> outcome;
  for (; !outcome; ++ticks) outcome = stage.script.tick(0.002 * ticks);
  CHECK(ticks == 6);
  CHECK(outcome->reason.empty());
}

}  // namespace
}  // namespace parallax::harness
