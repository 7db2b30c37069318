// Statements in a scenario that can never be meant: degrees, variables of another kind, and stops
// that a controller leads away from.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "harness/config/scenario.h"
#include "tests/harness/config/scenario_text.h"

namespace parallax::harness::test {
namespace {

const std::vector<std::string> kFluents = {"BoxIn(r1)", "BoxIn(r2)", "Holding()", "RobotIn(r1)",
                                           "RobotIn(r2)"};
const std::vector<std::string> kEvents = {"Go(r1)", "Go(r2)", "PickUp()", "Place(r1)"};

/// Reports of loading the scenario and checking it against the model.
std::vector<std::string> reports_of(const std::string& text) {
  Workspace workspace;
  const auto scenario = workspace.load(text);
  if (scenario) (void)check_against_model(*scenario, kFluents, kEvents, workspace.sink);
  return workspace.reports();
}

TEST_CASE("an angle of more than a turn, or far from any, is refused where it is sampled") {
  for (const auto& [interval, is_fine] :
       std::vector<std::pair<std::string, bool>>{{"[-11, 11]", false},
                                                 {"[-180, 180]", false},
                                                 {"[0, 90]", false},
                                                 {"[80, 85]", false},
                                                 {"45", false},
                                                 {"[-3.15, 3.15]", true},
                                                 {"[0, 6.2832]", true},
                                                 {"[3, 9]", true},
                                                 {"-1.57", true}}) {
    CAPTURE(interval);
    const auto reports = reports_of(replaced(kScenario, "[-0.1, 0.1]", interval));
    CHECK(reports.empty() == is_fine);
    if (is_fine || reports.empty()) continue;
    CHECK(reports.size() == 1);
    CHECK(reports[0].find("E5126 at 18") == 0);
    CHECK(reports[0].find("sampling/box.yaw: ") != std::string::npos);
  }
  // A length is no angle.
  CHECK(reports_of(replaced(kScenario, "box.y: 0.0", "box.y: [-11, 11]")).empty());
}

TEST_CASE("a flag, a range and a text are read from variables of this kind") {
  const std::string flag = "Holding(): {flag: box.held}";
  for (const auto& [to, wrong] : std::vector<std::pair<std::string, std::string>>{
           {"Holding(): {flag: box.x}", "`box.x` is a number"},
           {"Holding(): {flag: box.yaw}", "`box.yaw` is a number"},
           {"Holding(): {range: box.held, holds: [0.5, 1], fails: [0, 0.4]}",
            "`box.held` is true or false"},
           {"Holding(): {equals: box.z, text: high}", "`box.z` is a number"},
           {"Holding(): {equals: box.held, text: high}", "`box.held` is true or false"},
           {"Holding(): {range: box.z, holds: [0.5, 1], fails: [0, 0.4]}", ""},
           {flag, ""}}) {
    CAPTURE(to);
    const auto reports = reports_of(replaced(kScenario, flag, to));
    CHECK(reports.empty() == wrong.empty());
    if (wrong.empty() || reports.empty()) continue;
    CHECK(reports.size() == 1);
    CHECK(reports[0].find("E5126 at 13:3: mapping/Holding/") == 0);
    CHECK(reports[0].find(wrong) != std::string::npos);
  }
  for (const char* key : {"unless", "only_if"}) {
    const auto reports =
        reports_of(replaced(kScenario, "unless: box.held", std::string(key) + ": box.z"));
    REQUIRE(reports.size() == 1);
    CHECK(reports[0].find(std::string("E5126 at 12:3: mapping/BoxIn/") + key) == 0);
  }
}

TEST_CASE("what an event is to bring about holds at the stop that its controller leads to") {
  Workspace workspace;
  auto scenario = workspace.load(kScenario);
  REQUIRE(scenario.has_value());
  // The slider `drive` goes from -1 to 2.5.
  const Interval at_low{-1.01, -0.9}, at_high{2.4, 2.51};
  for (const char* controller : {"open-drawer", "close-drawer"}) {
    const bool opens = std::string(controller) == "open-drawer";
    for (const bool is_initiated : {true, false}) {
      for (const bool holds_high : {true, false}) {
        auto changed = *scenario;
        changed.actions[1].controller = controller;
        changed.actions[1].arguments = {{"joint", std::string("drive")}};
        FluentBinding binding;
        binding.fluent = "Open";
        binding.condition =
            RangeBinding{"drive.q", holds_high ? at_high : at_low, holds_high ? at_low : at_high};
        changed.mapping.emplace(RegionMap(RegionSet()), std::vector<FluentBinding>{binding});
        const auto before = workspace.sink.error_count();
        check_stops(changed,
                    {{ground_fluent(changed.actions[1].event + "()"), ground_fluent("Open()"),
                      is_initiated}},
                    workspace.sink);
        const bool is_right = (opens == holds_high) == is_initiated;
        CHECK((workspace.sink.error_count() == before) == is_right);
      }
    }
  }
}

TEST_CASE("every key that takes an angle refuses degrees") {
  const auto is_refused = [](const std::string& from, const std::string& to) {
    Workspace workspace;
    workspace.write("world.yaml", replaced(kWorld, from, to));
    const auto scenario = workspace.load(kScenario);
    const auto reports = workspace.reports();
    CHECK(scenario.has_value() == reports.empty());
    return !reports.empty() && reports[0].find("angles are in radians") != std::string::npos;
  };
  const std::string place = "position_m: [1.5, 0, 0.035]";
  for (const char* degrees : {"90", "-180", "45"}) {
    CHECK(is_refused(place, place + ", yaw_rad: " + degrees));
    for (const char* key : {"yaw_rad", "pitch_rad", "roll_rad"}) {
      CHECK(is_refused("box: {size_m: [0.07, 0.07, 0.07]",
                       std::string("box: {shapes: [{size_m: [0.07, 0.07, 0.07], ") + key + ": " +
                           degrees + "}]"));
    }
    CHECK(is_refused(place, place + ", grasp: {width_m: 0.05, wrist_rad: " + degrees + "}"));
  }
  CHECK(!is_refused(place, place + ", yaw_rad: 0"));
}

TEST_CASE("regions, ranges and borders of angles are in radians") {
  const std::string cells = "{r1: {x: [0, 1]}, r2: {x: [1, 2]}}";
  for (const auto& [yaw, is_fine] :
       std::vector<std::pair<std::string, bool>>{{"[0, 90]", false},
                                                 {"[80, 85]", false},
                                                 {"[-3.1416, 3.1416]", true},
                                                 {"[0, 6.2832]", true}}) {
    CAPTURE(yaw);
    const auto with = "{r1: {x: [0, 1], yaw: " + yaw + "}, r2: {x: [1, 2], yaw: " + yaw + "}}";
    const auto reports = reports_of(replaced(kScenario, cells, with));
    const bool refused = std::any_of(reports.begin(), reports.end(),
                                     [](const std::string& one) { return one.find("E5209") == 0; });
    CHECK(refused != is_fine);
  }
  const std::string flag = "Holding(): {flag: box.held}";
  for (const auto& [to, is_fine] : std::vector<std::pair<std::string, bool>>{
           {"Holding(): {range: box.yaw, holds: [0, 90], fails: [91, 180]}", false},
           {"Holding(): {range: box.pitch, holds: [40, 50], fails: [-10, 10]}", false},
           {"Holding(): {start: box.yaw, above: 45}", false},
           {"Holding(): {range: box.yaw, holds: [0, 1.5], fails: [1.6, 3.1]}", true},
           {"Holding(): {range: box.x, holds: [0, 90], fails: [91, 180]}", true}}) {
    CAPTURE(to);
    const auto reports = reports_of(replaced(kScenario, flag, to));
    const bool refused = !reports.empty() && reports[0].find("in radians") != std::string::npos;
    CHECK(refused != is_fine);
  }
}

TEST_CASE("a normal law of an angle may have tails beyond a turn, but not a width in degrees") {
  for (const auto& [law, is_fine] :
       std::vector<std::pair<std::string, bool>>{{"{normal: {mean: 0, sd: 0.5}}", true},
                                                 {"{normal: {mean: 0, sd: 30}}", false},
                                                 {"{normal: {mean: 90, sd: 0.5}}", false},
                                                 {"{triangular: [-90, 0, 90]}", false},
                                                 {"{choice: {0: 1, 90: 1}}", false},
                                                 {"{choice: {0: 1, 1.57: 1}}", true}}) {
    CAPTURE(law);
    CHECK(reports_of(replaced(kScenario, "[-0.1, 0.1]", law)).empty() == is_fine);
  }
}

TEST_CASE("borders and conditions read numbers") {
  auto reports = reports_of(replaced(kScenario, "Holding(): {flag: box.held}",
                                     "Holding(): {start: box.held, above: 0.5}"));
  REQUIRE(!reports.empty());
  CHECK(reports[0].find("E5126 at 13:3: mapping/Holding/start: asks for a number") == 0);
  reports = reports_of(
      replaced(kScenario, "inset_m: 0.001,", "inset_m: 0.001, require: [\"box.held < 1\"],"));
  REQUIRE(!reports.empty());
  CHECK(reports[0].find("formulas compute with numbers") != std::string::npos);
}

TEST_CASE("names with placeholders are filled in before stops are compared") {
  Workspace workspace;
  auto scenario = workspace.load(kScenario);
  REQUIRE(scenario.has_value());
  auto changed = *scenario;
  changed.actions[1].controller = "open-drawer";
  changed.actions[1].arguments = {{"joint", std::string("{0}")}};
  const auto event = changed.actions[1].event;
  const auto faults = [&](const std::string& variable, Interval holds, Interval fails,
                          State planned) {
    FluentBinding binding;
    binding.fluent = "Open";
    binding.condition = RangeBinding{variable, holds, fails};
    changed.mapping.emplace(RegionMap(RegionSet()), std::vector<FluentBinding>{binding});
    const auto before = workspace.sink.error_count();
    check_stops(changed,
                {{ground_fluent(event + "(drive)"), ground_fluent("Open(drive)"), true,
                  std::move(planned)}},
                workspace.sink);
    return workspace.sink.error_count() - before;
  };
  const Interval low{-1.01, -0.9}, high{2.4, 2.51};  // the slider goes from -1 to 2.5
  CHECK(faults("{0}.q", low, high, {}) == 1);
  CHECK(faults("{0}.q", high, low, {}) == 0);
  CHECK(faults("reach.q", low, high, {}) == 0);
  // The slider carries the base, which begins at 0.5 m.
  CHECK(faults("base.x", {-0.51, -0.4}, {2.9, 3.01}, {}) == 1);
  CHECK(faults("base.x", {2.9, 3.01}, {-0.51, -0.4}, {}) == 0);
  // The plan's word counts before that of the action.
  CHECK(faults("{0}.q", low, high, {{"joint", std::string("reach")}}) == 0);
}

}  // namespace
}  // namespace parallax::harness::test
