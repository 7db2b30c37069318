// Doors on hinges, opened and closed by a hand that takes them by their handle, in the physics
// engine.

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/harness/doors/door_world.h"
#include "tests/harness/engine/engines.h"

namespace parallax::harness::test {
namespace {

const WorldSpec& house() {
  static const WorldSpec world = door_world();
  return world;
}

Outcome move(Robot& robot, const char* controller, State more = {}) {
  more.insert({{"arm", std::string("arm")}, {"joint", std::string("hinge")}});
  return robot.act(controller, more);
}
Outcome open(Robot& robot, State more = {}) { return move(robot, "open-door", std::move(more)); }
Outcome close(Robot& robot, State more = {}) { return move(robot, "close-door", std::move(more)); }
Outcome park(Robot& robot) { return robot.act("park", {{"arm", std::string("arm")}}); }
Outcome settle(Robot& robot, double time_s) {
  return robot.act("open-gripper", {{"arm", std::string("arm")}, {"settle_s", time_s}});
}
bool ok(const Outcome& outcome) { return outcome.status == SimStatus::kOk; }

double margin(const Outcome& outcome, const char* name) {
  return std::get<double>(outcome.margins.at(name));
}

/// The middle of the bar, from where the leaf is; not by the code that leads the hand.
Eigen::Vector3d bar(const Robot& robot) {
  return robot.position("leaf") + robot.rotation("leaf") * Eigen::Vector3d(-0.07, 0.36, 0.0);
}

double yaw_of(const Robot& robot, const char* body) {
  const Eigen::Matrix3d R = robot.rotation(body);
  return std::atan2(R(1, 0), R(0, 0));
}

/// To its stop, where it stays, and to the other.
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

/// The house seen in a mirror along y: the door turns the other way.
WorldSpec mirrored(WorldSpec spec) {
  body_of(spec, "leaf").p_WB.y() *= -1.0;
  for (BodyShape& shape : body_of(spec, "leaf").shapes) shape.p_BS.y() *= -1.0;
  JointSpec& hinge = joint_of(spec, "hinge");
  hinge.p_WA.y() *= -1.0;
  hinge.axis_W *= -1.0;
  hinge.handle->p_CH.y() *= -1.0;
  hinge.handle->approach.y() *= -1.0;
  for (const char* name : {"wall_left", "wall_right", "stand", "block"}) {
    body_of(spec, name).p_WB.y() *= -1.0;
  }
  return spec;
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

/// A cupboard door of half a metre, turned the other way round, and an arm of joints before it.
WorldSpec cupboard(const std::string& height_m) {
  std::string text = replaced(kDoorWorld, "mobile_palm", "mobile_six_joint");
  text = replaced(text, "position_m: [-0.03, -0.005, 1.05]", "position_m: [-0.03, -0.175, 1.05]");
  text = replaced(text, "[0.04, 0.84, 2.0]", "[0.04, 0.5, " + height_m + "]");
  for (int i = 0; i < 2; ++i) text = replaced(text, "[-0.07, 0.36, 0]", "[-0.07, 0.19, 0]");
  return mirrored(door_world(text));
}

TEST_CASE(
    "an arm of joints opens a cupboard and shuts it, or says before it begins that it cannot") {
  const WorldSpec spec = cupboard("0.3");
  int opened = 0, refused = 0;
  for (const double x : {-0.90, -0.79, -0.69}) {
    for (const double y : {-0.06, 0.04, 0.09}) {
      for (const double yaw : {0.156, 0.656}) {
        CAPTURE(x);
        CAPTURE(y);
        CAPTURE(yaw);
        Robot robot(spec, {{"robot.x", x}, {"robot.y", y}, {"robot.yaw", yaw}});
        const Outcome outcome = open(robot);
        CAPTURE(outcome.reason);
        if (ok(outcome)) {
          ++opened;
          CHECK(robot.number("hinge.q") == doctest::Approx(1.6).epsilon(0.01));
          CHECK(close(robot).reason == "");
          CHECK(robot.number("hinge.q") < 0.01);
        } else {
          ++refused;
          CHECK(outcome.reason.starts_with("manipulation-pose-unreachable: "));
          CHECK(robot.number("hinge.q") < 0.001);
        }
      }
    }
  }
  CHECK(opened >= 4);
  CHECK(refused >= 4);
}

/// A box as the convex hull of its corners.
BodyShape hull_of(const BodyShape& box) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    corners.push_back(0.5 * sign.cwiseProduct(box.size_m));
  }
  Eigen::Vector3d middle;
  std::string why;
  const auto hull = hull_with(corners,
                              {{0, 2, 1},
                               {1, 2, 3},
                               {4, 5, 6},
                               {5, 7, 6},
                               {0, 1, 4},
                               {1, 5, 4},
                               {2, 6, 3},
                               {3, 6, 7},
                               {0, 4, 2},
                               {2, 4, 6},
                               {1, 3, 5},
                               {3, 7, 5}},
                              middle, why);
  CAPTURE(why);
  REQUIRE(hull.has_value());
  BodyShape shape = box;
  shape.form = ShapeForm::kHull;
  shape.hull = std::make_shared<const ConvexHull>(*hull);
  return shape;
}

TEST_CASE("a link of an arm that is a hull is tried as a box of its size is") {
  for (const char* height : {"0.3", "2.0"}) {
    std::string reasons[2];
    for (const bool hulls : {false, true}) {
      WorldSpec spec = cupboard(height);
      BodyShape& fore = body_of(spec, "arm_fore").shapes.front();
      fore.form = ShapeForm::kBox;
      if (hulls) fore = hull_of(fore);
      Robot robot(spec, {{"robot.x", -0.74}, {"robot.y", 0.04}, {"robot.yaw", 0.656}});
      reasons[hulls ? 1 : 0] = open(robot).reason;
    }
    CHECK(reasons[0] == reasons[1]);
  }
}

TEST_CASE("a forearm that would have to pass through the leaf that the hand leads is told") {
  const State place = {{"robot.x", -0.74}, {"robot.y", 0.04}, {"robot.yaw", 0.656}};
  Robot before_low(cupboard("0.3"), place);
  CHECK(open(before_low).reason == "");
  Robot before_high(cupboard("2.0"), place);
  CHECK(open(before_high).reason ==
        "manipulation-pose-unreachable: at the handle `arm_fore` would meet `leaf`");
  CHECK(before_high.number("hinge.q") < 0.001);
}

}  // namespace
}  // namespace parallax::harness::test
