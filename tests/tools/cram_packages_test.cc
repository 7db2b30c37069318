// CRAM's own packages, as they are, with a little glue (tests/plans/cram/packages). Their files are
// not ours to ship: PARALLAX_CRAM names a folder with checkouts of the branches devel and master.

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
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
     20},
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
     8},
    {{kFailures2020, kMobile2020}, "(pp-plans::place MILK :left ?ps nil ?ps nil ?ps nil ?ps)", 7},
    {{kFailures2020, kMobile2020}, "(pp-plans::park-arms)", 5},
    {{kFailures2020, kMobile2020, kFetch2020}, "(pr2-fd-plans::go-without-collisions SPOT)", 5},
    {{kFailures2020, kMobile2020, kFetch2020}, "(pr2-fd-plans::search-for-object MILK SPOT)", 20},
    {{kFailures2020, kMobile2020, kFetch2020}, "(pr2-fd-plans::fetch MILK :left SPOT nil)", 30},
    {{kFailures2020, kMobile2020, kFetch2020}, "(pr2-fd-plans::deliver MILK SPOT SPOT nil)", 30},
    {{kFailures2020, kMobile2020, kFetch2020}, "(pr2-fd-plans::drop-at-sink)", 1},
};

std::string with_designators(std::string call) {
  const std::pair<std::string, std::string> words[] = {
      {"MILK", "(desig:an object (type milk) (name milk))"},
      {"SPOT", "(desig:a location (pose ?p))"}};
  for (const auto& [word, meaning] : words) {
    for (auto at = call.find(word); at != std::string::npos; at = call.find(word, at + 1)) {
      call.replace(at, word.size(), meaning);
    }
  }
  return "(let* ((?p (cl-transforms-stamped:make-pose-stamped \"map\" 0.0 "
         "(cl-transforms:make-3d-vector 1 0 1) (cl-transforms:make-identity-rotation)))"
         " (?ps (list ?p))) " +
         call + ")";
}

TEST_CASE("packages of CRAM are unrolled as they are") {
  const char* given = std::getenv("PARALLAX_CRAM");
  if (given == nullptr) {
    std::cout << "SKIPPED: no packages of CRAM (PARALLAX_CRAM)\n";
    return;
  }
  const CliFixture cli;
  const fs::path cram = given;
  for (const auto& [folders, call, locations] : kCalls) {
    CAPTURE(call);
    std::vector<std::string> words = {"compile",
                                      (kGlue / "robot.e").string(),
                                      "--horizon=12",
                                      "--bind",
                                      (kGlue / "robot.bind").string(),
                                      "--emit=cfg",
                                      "--allow-outside",
                                      "--plan-entry",
                                      with_designators(call),
                                      "--plan",
                                      (kGlue / "robot.lisp").string()};
    for (const auto& folder : folders) {
      words.emplace_back("--plan");
      words.push_back((cram / folder).string());
    }
    const auto result = cli.parallax(words);
    CAPTURE(result.err);
    CHECK(result.code == 0);
    int found = 0;
    for (auto at = result.out.find("\nL"); at != std::string::npos;) {
      ++found;
      at = result.out.find("\nL", at + 1);
    }
    CHECK(found >= locations);
  }
}

}  // namespace
}  // namespace parallax::test
