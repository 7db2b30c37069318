// What a scenario says that can never be meant: degrees, variables of another kind, and stops that
// a controller leads away from.

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

/// What checking the scenario says, the first time it says something.
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
        check_stops(changed, {{changed.actions[1].event, "Open", is_initiated}}, workspace.sink);
        const bool is_right = (opens == holds_high) == is_initiated;
        CHECK((workspace.sink.error_count() == before) == is_right);
      }
    }
  }
}

}  // namespace
}  // namespace parallax::harness::test
