// Doors on hinges, opened and closed by a hand that takes them by their handle, in the physics
// engine.

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/harness/doors/door_world.h"
#include "tests/harness/engine/engines.h"

namespace parallax::harness::test {
namespace {

/// Moves the door to its stop, where it stays, and to the other.
void open_and_close(const WorldSpec& spec) {
  Robot robot(spec, beside());
  const Outcome opened = open(robot);
  CHECK(opened.reason == "");
  CHECK(robot.number("hinge.q") == doctest::Approx(1.6).epsilon(0.01));
  CHECK(margin(opened, "stop") == doctest::Approx(0.05).epsilon(0.2));
  // Off the handle, the hand does not hold it there.
  CHECK((robot.position("palm") - bar(robot)).norm() > 0.15);
  REQUIRE(ok(park(robot)));
  const double left = robot.number("hinge.q");
  REQUIRE(ok(settle(robot, 5.0)));
  CHECK(robot.number("hinge.q") == doctest::Approx(left).epsilon(1e-3));
  CHECK(close(robot).reason == "");
  CHECK(std::abs(robot.number("hinge.q")) < 0.01);
  CHECK(ok(park(robot)));
}

TEST_CASE("a door is opened to its stop, stays there, and is closed to the other, by any engine") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    open_and_close(stepped_by(engine, house()));
  }
}

TEST_CASE("the base stands still, the hand keeps the bar, and the wrist turns with the leaf") {
  Robot robot(house(), beside());
  const Eigen::Vector3d base = robot.position("chassis");
  std::vector<double> reach_m, turn_rad, q;
  double most_base_m = 0.0;
  robot.watch([&](const OdeSimulator&) {
    most_base_m = std::max(most_base_m, (robot.position("chassis") - base).norm());
    const double angle = yaw_of(robot, "leaf");
    if (angle < 0.1 || angle > 1.5) return;  // on the way
    q.push_back(angle);
    reach_m.push_back((robot.position("palm") - bar(robot)).norm());
    turn_rad.push_back(std::remainder(yaw_of(robot, "palm") - angle, 2.0 * M_PI));
  });
  REQUIRE(ok(open(robot)));
  REQUIRE(q.size() > 1000);
  CHECK(std::is_sorted(q.begin(), q.end()));  // the door never swings ahead and back
  const auto [near, far] = std::minmax_element(reach_m.begin(), reach_m.end());
  CHECK(*far - *near < 0.01);
  const auto [least, most] = std::minmax_element(turn_rad.begin(), turn_rad.end());
  CHECK(*most - *least < 0.05);
  CHECK(most_base_m < 0.005);
}

TEST_CASE("a door that is where it is to be is not touched") {
  Robot robot(house(), beside());
  const Eigen::Vector3d hand = robot.position("palm");
  const Outcome closed = close(robot);
  CHECK(ok(closed));
  CHECK(closed.sim_time_s == 0.0);
  CHECK((robot.position("palm") - hand).norm() == 0.0);
}

TEST_CASE(
    "a handle out of reach is refused, and so is one that leaves it on the way; nothing moves") {
  State start;
  std::string reason;
  SUBCASE("from the beginning") {
    start = {{"robot.x", -1.6}, {"robot.y", 0.3}, {"robot.yaw", -0.656}};
    reason = "manipulation-pose-unreachable: the handle of `hinge` is 1.";
  }
  SUBCASE("near the end") {
    start = {{"robot.x", -0.7}, {"robot.y", 0.8}, {"robot.yaw", -0.9}};
    reason = "manipulation-pose-unreachable: the handle of `hinge`, turned by ";
  }
  Robot robot(house(), start);
  const Eigen::Vector3d hand = robot.position("palm");
  const Outcome outcome = open(robot);
  CAPTURE(outcome.reason);
  CHECK(outcome.status == SimStatus::kFailed);
  CHECK(outcome.reason.starts_with(reason));
  CHECK(margin(outcome, "reach") < 0.0);
  CHECK(robot.number("hinge.q") == doctest::Approx(0.0));
  CHECK((robot.position("palm") - hand).norm() == 0.0);
}

TEST_CASE("a robot in the arc of the door does not open it") {
  Robot robot(house(), {{"robot.x", -0.8}, {"robot.y", 0.05}, {"robot.yaw", 0.0}});
  const Outcome outcome = open(robot);
  CHECK(outcome.reason ==
        "manipulation-pose-unreachable: on the arc of `hinge` `leaf` would meet `chassis`");
  CHECK(robot.number("hinge.q") == doctest::Approx(0.0));
}

TEST_CASE("what slides in the arc of the door is told before anything moves") {
  WorldSpec spec = house();
  BodySpec chest = body_of(spec, "stand");
  chest.name = "chest";
  chest.p_WB = {-0.5, -0.3, 0.35};
  chest.mass_kg = 40.0;
  JointSpec rail;
  rail.name = "rail";
  rail.child = "chest";
  rail.low_m = -0.2;
  rail.high_m = 0.2;
  spec.bodies.push_back(chest);
  spec.joints.push_back(rail);
  Robot robot(spec, beside());
  CHECK(open(robot).reason ==
        "manipulation-pose-unreachable: on the arc of `hinge` `leaf` would meet `chest`");
  CHECK(robot.number("hinge.q") == doctest::Approx(0.0));
}

TEST_CASE("a door that meets something heavy is short of its stop, a light thing it pushes along") {
  const State in_the_arc = {{"load.x", -0.5}, {"load.y", -0.35}};
  SUBCASE("heavy") {
    Robot robot(house(), beside(in_the_arc));
    const Outcome outcome = open(robot);
    CAPTURE(outcome.reason);
    CHECK(outcome.status == SimStatus::kFailed);
    const double q = robot.number("hinge.q");
    CHECK(q > 0.5);
    CHECK(q < 1.4);
    CHECK(outcome.reason.starts_with("manipulation-goal-not-reached: `hinge` is "));
    CHECK(outcome.reason.find(" rad short of its stop") != std::string::npos);
    CHECK(margin(outcome, "stop") == doctest::Approx(0.05 - (1.6 - q)).epsilon(0.02));
    CHECK(std::abs(robot.number("load.x") + 0.5) < 0.03);
  }
  SUBCASE("light") {
    State start = beside(in_the_arc);
    start["load.mass"] = 2.0;
    Robot robot(house(), start);
    CHECK(open(robot).reason == "");
    CHECK(robot.number("load.y") < -0.6);
  }
}

TEST_CASE("a door that sticks more than the hand can pull stays shut, one that sticks less opens") {
  for (const double torque_nm : {20.0, 400.0}) {
    CAPTURE(torque_nm);
    WorldSpec spec = house();
    joint_of(spec, "hinge").max_torque_nm = torque_nm;
    Robot robot(spec, beside());
    const Outcome outcome = open(robot);
    CAPTURE(outcome.reason);
    CHECK(ok(outcome) == (torque_nm < 100.0));
    if (torque_nm > 100.0) CHECK(robot.number("hinge.q") < 0.1);
  }
}

/// Takes the block from the stand beside the robot.
void take_block(Robot& robot) {
  robot.find("stand", "block");
  const Outcome picked =
      robot.act("pick-up", {{"arm", std::string("arm")}, {"object", std::string("block")}});
  CAPTURE(picked.reason);
  REQUIRE(ok(picked));
  REQUIRE(ok(park(robot)));
}

TEST_CASE("a hand that holds something shuts the door with the palm, and keeps what it holds") {
  Robot robot(house(), beside());
  REQUIRE(ok(open(robot)));
  REQUIRE(ok(park(robot)));
  take_block(robot);
  double nearest_m = 1.0;
  robot.watch([&](const OdeSimulator&) {
    nearest_m = std::min(nearest_m, (robot.position("palm") - bar(robot)).norm());
  });
  CHECK(close(robot).reason == "");
  CHECK(std::abs(robot.number("hinge.q")) < 0.05);
  CHECK(nearest_m > 0.055);  // the palm is at the bar, not round it
  CHECK(nearest_m < 0.075);
  CHECK(robot.flag("block.held_by.arm"));
  CHECK(ok(park(robot)));
  CHECK(robot.flag("block.held_by.arm"));
}

TEST_CASE("a palm that would have to push from behind the closed door does not reach there") {
  Robot robot(house(), beside());
  take_block(robot);
  const Outcome outcome = open(robot);
  CAPTURE(outcome.reason);
  CHECK(outcome.reason.starts_with("manipulation-pose-unreachable: the handle of `hinge`"));
  CHECK(robot.flag("block.held_by.arm"));
  CHECK(robot.number("hinge.q") == doctest::Approx(0.0));
}

/// Refused as long as the door is shut and the hand is where it was.
void check_refused_untouched(const WorldSpec& spec, const std::string& reason) {
  Robot robot(spec, beside());
  const Eigen::Vector3d hand = robot.position("palm");
  double most_rad = 0.0;
  robot.watch(
      [&](const OdeSimulator&) { most_rad = std::max(most_rad, std::abs(yaw_of(robot, "leaf"))); });
  const Outcome outcome = open(robot);
  CHECK(outcome.status == SimStatus::kFailed);
  CHECK(outcome.reason == reason);
  CHECK(most_rad < 1e-3);
  CHECK((robot.position("palm") - hand).norm() < 0.005);
}

TEST_CASE(
    "a hand that would come through the leaf, or with a pad in it, does not reach for the handle") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    WorldSpec spec = stepped_by(engine, house());
    HandleSpec& handle = *joint_of(spec, "hinge").handle;
    SUBCASE("from behind the leaf") {
      handle.approach = {-1.0, 0.0, 0.0};
      check_refused_untouched(
          spec, "manipulation-pose-unreachable: at the handle `far_pad` would meet `leaf`");
    }
    SUBCASE("the pads along the bar") {
      handle.wrist_rad = 0.0;
      check_refused_untouched(
          spec, "manipulation-pose-unreachable: at the handle `near_pad` would meet `leaf`");
    }
  }
}

TEST_CASE(
    "a palm pushes a door open from behind, but not on a way in that leads through the leaf") {
  for (const bool through : {false, true}) {
    CAPTURE(through);
    WorldSpec spec = house();
    joint_of(spec, "hinge").high_rad = 0.3;
    joint_of(spec, "hinge").handle->approach = {through ? 1.0 : -1.0, 0.0, 0.0};
    body_of(spec, "stand").p_WB = {0.33, 0.74, 0.35};
    body_of(spec, "block").p_WB = {0.33, 0.74, 0.75};
    for (PlaceSpec& place : spec.places) place.p_FP = {0.33, 0.74, 0.75};
    Robot robot(spec, {{"robot.x", 0.5}, {"robot.y", 0.1}, {"robot.yaw", M_PI}});
    take_block(robot);
    const Outcome outcome = open(robot);
    CAPTURE(outcome.reason);
    if (through) {
      CHECK(outcome.reason.starts_with("manipulation-pose-unreachable: at the handle `"));
      CHECK(outcome.reason.ends_with("` would meet `leaf`"));
      CHECK(std::abs(robot.number("hinge.q")) < 1e-3);
    } else {
      CHECK(outcome.reason == "");
      CHECK(robot.number("hinge.q") == doctest::Approx(0.3).epsilon(0.02));
    }
    CHECK(robot.flag("block.held_by.arm"));
  }
}

TEST_CASE("pads that close on air, above the bar, do not lead the hand along the arc") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    WorldSpec spec = stepped_by(engine, house());
    HandleSpec& handle = *joint_of(spec, "hinge").handle;
    handle.p_CH.z() = 0.035;  // the bar is 2 cm thick, a pad 3 cm high
    handle.width_m = 0.06;    // something of the bar is that near
    Robot robot(spec, beside());
    const Outcome outcome = open(robot);
    CHECK(outcome.status == SimStatus::kFailed);
    CHECK(outcome.reason ==
          "object-not-held: nothing of `leaf` is between the closed pads: the handle of `hinge` "
          "was missed");
    CHECK(std::abs(robot.number("hinge.q")) < 0.01);
  }
}

TEST_CASE("the same start gives the same bits, in any simulator") {
  std::vector<std::string> digests;
  for (int i = 0; i < 2; ++i) {
    Robot robot(house(), beside());
    REQUIRE(ok(open(robot)));
    REQUIRE(ok(close(robot)));
    digests.push_back(std::get<std::string>(robot.observed("digest")));
  }
  CHECK(digests[0] == digests[1]);
}

TEST_CASE("a door that turns the other way round is opened and closed alike") {
  // The shoulder is on the robot's left, so its place is no mirrored one.
  Robot robot(mirrored(house()), {{"robot.x", -0.92}, {"robot.y", -0.367}, {"robot.yaw", 0.656}});
  const Outcome opened = open(robot);
  CHECK(opened.reason == "");
  CHECK(robot.number("hinge.q") == doctest::Approx(1.6).epsilon(0.01));
  CHECK(yaw_of(robot, "leaf") == doctest::Approx(-1.6).epsilon(0.01));
  CHECK(close(robot).reason == "");
  CHECK(std::abs(yaw_of(robot, "leaf")) < 0.01);
}

/// The house turned about the vertical through the origin.
WorldSpec turned(WorldSpec spec, double angle_rad) {
  const Eigen::AngleAxisd turn(angle_rad, Eigen::Vector3d::UnitZ());
  for (const char* name : {"wall_left", "wall_right", "stand", "block", "leaf"}) {
    BodySpec& body = body_of(spec, name);
    body.p_WB = turn * body.p_WB;
    body.yaw_rad += angle_rad;
  }
  JointSpec& hinge = joint_of(spec, "hinge");
  hinge.p_WA = turn * hinge.p_WA;
  hinge.handle->approach = turn * hinge.handle->approach;
  hinge.handle->wrist_rad += angle_rad;
  return spec;
}

TEST_CASE("a house that stands otherwise in the world has the same door") {
  for (const double angle : {1.0, -2.5}) {
    CAPTURE(angle);
    const Eigen::Vector3d place =
        Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d(-1.04, 0.21, 0.0);
    Robot robot(turned(house(), angle), {{"robot.x", place.x()},
                                         {"robot.y", place.y()},
                                         {"robot.yaw", std::remainder(angle - 0.656, 2.0 * M_PI)}});
    CHECK(open(robot).reason == "");
    CHECK(robot.number("hinge.q") == doctest::Approx(1.6).epsilon(0.01));
    CHECK(ok(park(robot)));
    CHECK(close(robot).reason == "");
    CHECK(std::abs(robot.number("hinge.q")) < 0.01);
  }
}

}  // namespace
}  // namespace parallax::harness::test
