// Arms that are chains of joints, in the physics engine.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "harness/engine/world_check.h"
#include "tests/harness/arms/arm_robot.h"

namespace parallax::harness {
namespace {

TEST_CASE("an arm at rest stays where its motors hold it, the palm level") {
  Robot robot(chain_warehouse());
  const Eigen::Vector3d before = robot.position("left_palm");
  robot.wait(2.0);
  CHECK((robot.position("left_palm") - before).norm() < 2e-4);
  CHECK(robot.leans_rad("left_palm") < 1e-3);
}

TEST_CASE("a part is picked up, the hand level all the way") {
  Robot robot(chain_warehouse());
  robot.find("binA", "crate");
  double most_lean = 0.0;
  robot.watch(
      [&](const OdeSimulator&) { most_lean = std::max(most_lean, robot.leans_rad("left_palm")); });
  const Outcome outcome = robot.pick("crate");
  CHECK(outcome.reason == "");
  CHECK(robot.flag("crate.held_by.left"));
  CHECK(most_lean > 0.0);
  CHECK(most_lean < 0.02);
}

TEST_CASE("the palm follows a line of a quarter of a metre a second to a millimetre") {
  Robot robot(chain_warehouse());
  robot.find("binA", "crate");
  REQUIRE(robot.pick("crate").status == SimStatus::kOk);
  const Eigen::Vector3d from = robot.position("left_palm");
  std::vector<Eigen::Vector3d> seen;
  robot.watch([&](const OdeSimulator&) { seen.push_back(robot.position("left_palm")); });
  // From over the bin nothing is in the way of where it is carried.
  REQUIRE(robot.act("park", {{"arm", std::string("left")}}).status == SimStatus::kOk);
  const Eigen::Vector3d ahead = (robot.position("left_palm") - from).normalized();
  double most_m = 0.0;
  for (const Eigen::Vector3d& p : seen) {
    most_m = std::max(most_m, (p - from - ahead * ahead.dot(p - from)).norm());
  }
  CHECK(seen.size() > 100);
  CHECK(most_m < 1e-3);
}

constexpr double kPostX_m = 0.50, kPostY_m = 0.33, kPostLow_m = 1.10, kPostHigh_m = 1.60;

/// A post that hangs beside the palm's way to the bin, where the forearm would be.
BodySpec post() {
  BodySpec body;
  body.name = "post";
  body.shapes = {BodyShape{{0.02, 0.02, kPostHigh_m - kPostLow_m}}};
  body.p_WB = {kPostX_m, kPostY_m, 0.5 * (kPostLow_m + kPostHigh_m)};
  body.material = "wood";
  return body;
}

/// Picks the crate up, and tells whether a part of the robot was ever where the post is, or would
/// be.
std::pair<Outcome, bool> pick_beside_post(WorldSpec spec, bool is_there) {
  if (is_there) spec.bodies.push_back(post());
  Robot robot(spec);
  robot.find("binA", "crate");
  Probe place{post().shapes[0].size_m, post().p_WB};
  const WorldLayout& layout = robot.world().layout();
  std::vector<BodyId> parts;
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (layout.assembly_of[i] == layout.assembly_of[layout.find_body("base")->index()]) {
      parts.push_back(layout.bodies.id_at(i));
    }
  }
  bool met = false;
  robot.watch([&](const OdeSimulator&) {
    for (const BodyId part : parts) met = met || robot.world().overlaps(place, part);
  });
  Outcome outcome = robot.pick("crate");
  return {std::move(outcome), met};
}

TEST_CASE("what is in the way of a forearm alone is kept clear of, or named") {
  // The palm on its gantry passes the post; nothing of it comes near.
  const auto palms = pick_beside_post(world_of("arms/warehouse_palms.yaml"), true);
  CHECK(palms.first.status == SimStatus::kOk);
  CHECK_FALSE(palms.second);
  // The arm would be where the post is, if it were not there.
  const auto alone = pick_beside_post(chain_warehouse(), false);
  CHECK(alone.first.status == SimStatus::kOk);
  CHECK(alone.second);
  const auto arms = pick_beside_post(chain_warehouse(), true);
  CHECK_FALSE(arms.second);
  if (arms.first.status != SimStatus::kOk) {
    CAPTURE(arms.first.reason);
    CHECK(arms.first.reason.find("`post`") != std::string::npos);
  }
}

TEST_CASE(
    "an elbow that is too weak for the stretched arm gives way, and the tool does not arrive") {
  const auto short_m = [](double elbow_nm) {
    WorldSpec spec = chain_warehouse();
    joint_of(spec, "left_elbow").max_torque_nm = elbow_nm;
    REQUIRE(check_world(spec).empty());
    Robot robot(spec);
    robot.find("binA", "crate");
    REQUIRE(robot.pick("crate").status == SimStatus::kOk);
    robot.act("place", {{"arm", std::string("left")},
                        {"target.x", 0.88},
                        {"target.y", 0.2},
                        {"target.z", 0.72},
                        {"hover_m", 0.15}});
    return std::hypot(robot.number("crate.x") - 0.88, robot.number("crate.y") - 0.2);
  };
  // Forearm and hand weigh 3.5 kg, which takes 10.8 N m where the arm is carried, and 14 N m with
  // the crate and the forearm level.
  CHECK(short_m(30.0) < 0.02);
  CHECK(short_m(11.0) > 0.05);
}

TEST_CASE("what the joints do not reach is refused with what is missing") {
  Robot robot(chain_warehouse());
  robot.find("binA", "crate");
  REQUIRE(robot.pick("crate").status == SimStatus::kOk);
  const Outcome outcome = robot.act("place", {{"arm", std::string("left")},
                                              {"target.x", 1.6},
                                              {"target.y", 0.2},
                                              {"target.z", 0.8},
                                              {"object", std::string("crate")}});
  CHECK(outcome.status == SimStatus::kFailed);
  CHECK(
      outcome.reason.starts_with("manipulation-pose-unreachable: the place is beyond the joints of "
                                 "the left arm: the tool comes to within "));
  // From the shoulder at 1.05 m the arm ends at about 1.1 m.
  CHECK(std::get<double>(outcome.margins.at("reach")) < -0.4);
  CHECK(std::get<double>(outcome.margins.at("reach")) > -0.9);
}

TEST_CASE("a hand that cannot be turned where it is turns on its way to where it grasps") {
  // The drawer is open, the elbow folded: the spoon lies the other way round than the handle.
  Robot robot(world_of("arms/kitchen_plan2_arms.yaml"), {{"robot.x", 0.71},
                                                         {"robot.y", 0.095},
                                                         {"robot.yaw", -0.0153},
                                                         {"spoon1.x", 1.4811},
                                                         {"spoon1.y", 0.8932},
                                                         {"spoon1.bottom", 0.7},
                                                         {"spoon1.yaw", -0.0267}});
  const State left = {{"arm", std::string("left")}};
  State drawer = left, spoon = left;
  drawer["joint"] = std::string("dTop");
  spoon["object"] = std::string("spoon1");
  REQUIRE(robot.act("open-drawer", drawer).status == SimStatus::kOk);
  robot.find("dTop", "spoon");
  const Eigen::Vector3d before = robot.position("drawer_top");
  double moved_m = 0.0;
  robot.watch([&](const OdeSimulator&) {
    moved_m = std::max(moved_m, (robot.position("drawer_top") - before).norm());
  });
  const Outcome outcome = robot.act("pick-up", spoon);
  CHECK(outcome.reason == "");
  CHECK(robot.flag("spoon1.held_by.left"));
  CHECK(moved_m < 0.002);
}

TEST_CASE("a run gives the same bits again") {
  std::string digests[2];
  for (std::string& digest : digests) {
    Robot robot(chain_warehouse());
    robot.find("binA", "crate");
    robot.pick("crate");
    digest = std::get<std::string>(robot.observed("digest"));
  }
  CHECK(digests[0] == digests[1]);
}

std::string complaint(const WorldSpec& spec) {
  const auto problems = check_world(spec);
  return problems.empty() ? std::string() : problems[0].path + ": " + problems[0].message;
}

TEST_CASE("chains that are none are refused") {
  WorldSpec spec = chain_warehouse();
  ArmSpec& arm = spec.mobile->arms[0];
  const std::vector<std::string> chain = arm.chain;
  REQUIRE(complaint(spec) == "");

  arm.chain[2] = "left_elbw";
  CHECK(complaint(spec) == "robot/arms/left/chain: no joint `left_elbw`");
  arm.chain = chain;
  std::swap(arm.chain[1], arm.chain[2]);
  CHECK(complaint(spec).find("does not hang on what `left_pan` carries") != std::string::npos);
  arm.chain = {chain.begin(), chain.end() - 1};
  CHECK(complaint(spec) ==
        "robot/arms/left/chain: `left_roll`, the last, does not carry `left_palm`");
  arm.chain = chain;
  joint_of(spec, "left_lift").max_torque_nm = 5.0;
  CHECK(
      complaint(spec).find("the motor of `left_lift` gives 5 N m; to hold the arm as it is placed "
                           "takes ") != std::string::npos);
  joint_of(spec, "left_lift").max_torque_nm = 0.0;
  CHECK(complaint(spec) == "robot/arms/left/chain: `left_lift` has no motor: max_torque_nm is 0");
  joint_of(spec, "left_lift").max_torque_nm = 90.0;
  joint_of(spec, "left_yaw").low_rad.reset();
  CHECK(complaint(spec) == "robot/arms/left/chain: `left_yaw` has no stops: it needs `range_rad`");
  joint_of(spec, "left_yaw").low_rad = -3.0;
  arm.carry_B.x() = 2.0;
  CHECK(complaint(spec).starts_with("robot/arms/left/carry_m: is out of the chain's reach"));
}

}  // namespace
}  // namespace parallax::harness
