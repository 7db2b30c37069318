// CRAM's own packages, as they are, with a little glue (tests/plans/cram/packages). Their files are
// not ours to ship: PARALLAX_CRAM names a folder with checkouts of the branches devel and master.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
const fs::path kGlue = fs::path(PARALLAX_SOURCE_DIR) / "tests" / "plans" / "cram" / "packages";

struct PackageCall {
  std::vector<std::string> folders;
  std::string call;
  int locations = 0;  // at least
  std::string events =
      {};  // of a trace that must be there, worked out by hand from the plan's text
};

const std::string kFailures = "devel/cram_interfaces/cram_common_failures";
const std::string kMobile = "devel/cram_actions/cram_mobile_pick_place_plans";
const std::string kFetch = "devel/cram_actions/cram_fetch_deliver_plans";
const std::string kCut = "devel/cram_actions/cram_cut_plans";
const std::string kContainer = "devel/cram_actions/cram_urdf_environment_manipulation";
const std::string kFailures2020 = "master/cram_common/cram_common_failures";
const std::string kMobile2020 = "master/cram_common/cram_mobile_pick_place_plans";
const std::string kFetch2020 = "master/cram_pr2/cram_pr2_fetch_deliver_plans";

/// `?p` is a pose, `?ps` a list of it; MILK and SPOT stand for designators.
const std::vector<PackageCall> kCalls = {
    {{kFailures, kMobile},
     "(pp-plans::pick-up :object MILK :arm (list :left) :gripper-opening 0.1 :effort 10"
     " :left-grasp :top :look-pose ?p :left-reach-poses ?ps :left-grasp-poses ?ps"
     " :left-lift-poses ?ps)",
     20,
     "Look() SetGripper(left) MoveTcp(allowAll) MoveTcp(allowHand) Grip(left,milk) "
     "MoveTcp(allowAll) MoveArms() "},
    {{kFailures, kMobile},
     "(pp-plans::place :object MILK :arm (list :left) :target SPOT :gripper-opening 0.1"
     " :left-grasp :top :look-pose ?p :left-reach-poses ?ps :left-put-poses ?ps"
     " :left-retract-poses ?ps)",
     15},
    {{kFailures, kMobile}, "(pp-plans::park-arms :left-arm t :right-arm t)", 4},
    {{kFailures, kMobile}, "(exe:perform (desig:an action (type parking-arms)))", 4},
    {{kFailures, kMobile, kFetch}, "(fd-plans::go-without-collisions :location SPOT)", 1},
    {{kFailures, kMobile, kFetch}, "(fd-plans::turn-towards :target SPOT :robot-location SPOT)", 8},
    {{kFailures, kMobile, kFetch},
     "(fd-plans::search-for-object :object MILK :location SPOT :robot-location SPOT)",
     20},
    {{kFailures, kMobile, kFetch},
     "(fd-plans::fetch :object MILK :arms '(:left) :location SPOT :robot-location SPOT"
     " :look-location SPOT)",
     25},
    {{kFailures, kMobile, kFetch},
     "(fd-plans::deliver :object MILK :arms '(:left) :target SPOT :robot-location SPOT)",
     50},
    {{kFailures, kMobile, kFetch}, "(fd-plans::drop-at-sink)", 1},
    {{kFailures, kMobile, kFetch, kContainer},
     "(env-man::manipulate-container :type :opening :arm :left :gripper-opening 0.1 :distance 0.3"
     " :look-pose ?p :left-reach-poses ?ps :left-grasp-poses ?ps :left-manipulate-poses ?ps"
     " :left-retract-poses ?ps :joint-name \"joint\" :link-name \"link\""
     " :environment-name :kitchen :container-object MILK)",
     10},
    {{kFailures, kMobile, kFetch, kCut},
     "(c-plans::slice :object MILK :left-slice-up-poses ?ps :left-slice-down-poses ?ps)",
     10},
    {{kFailures, kMobile, kFetch, kCut},
     "(c-plans::hold :object MILK :arm :left :gripper-opening 0.1 :effort 10"
     " :left-reach-poses ?ps :left-grasp-poses ?ps)",
     10},
    {{kFailures2020, kMobile2020},
     "(pp-plans::pick-up MILK :left 0.1 10 :top ?ps nil ?ps nil ?ps nil)",
     8,
     "SetGripper(left) MoveArms() MoveArms() MoveTcp(allowAll) MoveTcp(allowAll) Grip(left,milk) "
     "MoveTcp(allowHand) MoveTcp(allowHand) "},
    {{kFailures2020, kMobile2020}, "(pp-plans::place MILK :left ?ps nil ?ps nil ?ps nil ?ps)", 7},
    {{kFailures2020, kMobile2020}, "(pp-plans::park-arms)", 5},
    {{kFailures2020, kMobile2020, kFetch2020}, "(pr2-fd-plans::go-without-collisions SPOT)", 5},
    {{kFailures2020, kMobile2020, kFetch2020}, "(pr2-fd-plans::search-for-object MILK SPOT)", 20},
    {{kFailures2020, kMobile2020, kFetch2020}, "(pr2-fd-plans::fetch MILK :left SPOT nil)", 30},
    {{kFailures2020, kMobile2020, kFetch2020}, "(pr2-fd-plans::deliver MILK SPOT SPOT nil)", 30},
    {{kFailures2020, kMobile2020, kFetch2020}, "(pr2-fd-plans::drop-at-sink)", 1},
    {{kFailures2020, kMobile2020, kFetch2020},
     "(pr2-fd-plans::transport MILK SPOT SPOT :left t)",
     40},
    {{kFailures, kMobile, kFetch},
     "(fd-plans::transport :object MILK :search-location SPOT :deliver-location SPOT)",
     100},
};

std::string with_designators(std::string call) {
  const std::pair<std::string, std::string> words[] = {
      {"MILK", "(desig:an object (type milk) (name milk) (location ?spot))"}, {"SPOT", "?spot"}};
  for (const auto& [word, meaning] : words) {
    for (auto at = call.find(word); at != std::string::npos; at = call.find(word, at + 1)) {
      call.replace(at, word.size(), meaning);
    }
  }
  return "(let* ((?p (cl-transforms-stamped:make-pose-stamped \"map\" 0.0 "
         "(cl-transforms:make-3d-vector 1 0 1) (cl-transforms:make-identity-rotation)))"
         " (?ps (list ?p)) (?spot (desig:a location (pose ?p)))) " +
         call + ")";
}

std::vector<std::string> command(const std::string& name, const PackageCall& given,
                                 const fs::path& cram) {
  std::vector<std::string> words = {name,
                                    (kGlue / "robot.e").string(),
                                    "--bind",
                                    (kGlue / "robot.bind").string(),
                                    "--allow-outside",
                                    "--plan-entry",
                                    with_designators(given.call),
                                    "--plan",
                                    (kGlue / "robot.lisp").string()};
  for (const auto& folder : given.folders) {
    words.emplace_back("--plan");
    words.push_back((cram / folder).string());
  }
  return words;
}

/// The performs of each trace of a plan that is done, in one line.
std::set<std::string> traces_of(const CliFixture& cli, std::vector<std::string> words,
                                std::size_t performs) {
  words.insert(words.end(), {"--horizon", std::to_string(performs + 1), "--limit=0", "--ended=done",
                             "--format=jsonl"});
  std::set<std::string> out;
  std::istringstream lines(cli.parallax(words).out);
  for (std::string line; std::getline(lines, line);) {
    const auto trace = nlohmann::json::parse(line);
    if (!trace.contains("timepoints")) continue;
    std::string events;
    for (const auto& point : trace["timepoints"]) {
      for (const auto& event : point["happens"]) events += event.get<std::string>() + ' ';
    }
    out.insert(events);
  }
  return out;
}

TEST_CASE("packages of CRAM are unrolled as they are") {
  const char* given = std::getenv("PARALLAX_CRAM");
  if (given == nullptr) {
    std::cout << "SKIPPED: no packages of CRAM (PARALLAX_CRAM)\n";
    return;
  }
  const CliFixture cli;
  const fs::path cram = given;
  for (const auto& one : kCalls) {
    CAPTURE(one.call);
    auto words = command("compile", one, cram);
    words.insert(words.end(), {"--horizon=12", "--emit=cfg"});
    const auto result = cli.parallax(words);
    CAPTURE(result.err);
    CHECK(result.code == 0);
    int found = 0;
    for (auto at = result.out.find("\nL"); at != std::string::npos;) {
      ++found;
      at = result.out.find("\nL", at + 1);
    }
    CHECK(found >= one.locations);
    if (one.events.empty()) continue;
    const auto performs = std::count(one.events.begin(), one.events.end(), '(');
    const auto traces =
        traces_of(cli, command("traces", one, cram), static_cast<std::size_t>(performs));
    CHECK(traces.contains(one.events));
  }
}

}  // namespace
}  // namespace parallax::test
