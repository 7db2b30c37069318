#include <doctest/doctest.h>

#include <string>
#include <utility>

#include "tests/harness/kitchen/kitchen_world.h"

namespace parallax::harness {
namespace {

const State kNear = {{"robot.x", 0.78}, {"robot.y", 0.12}, {"robot.yaw", 0.05}};
const State kFar = {{"robot.x", 0.66}, {"robot.y", 0.0}};

/// Drives to the table from `start`, with `drawer` open unless empty.
Outcome leave(const WorldSpec& spec, const State& start, const std::string& drawer) {
  Kitchen kitchen(spec);
  kitchen.start(start);
  if (!drawer.empty()) {
    REQUIRE(ok(kitchen.open(drawer)));
    CHECK(kitchen.number(drawer + ".q") > 0.44);
    REQUIRE(ok(kitchen.park()));
  }
  const double x_m = kitchen.number("robot.x");
  const Outcome outcome = kitchen.drive("bTable");
  if (!ok(outcome)) CHECK(kitchen.number("robot.x") == doctest::Approx(x_m).epsilon(1e-3));
  return outcome;
}

TEST_CASE("an open drawer is in the way, depending on where the robot stands and which it is") {
  const Outcome blocked = leave(kitchen_world(), kNear, "dMid");
  CHECK(blocked.status == SimStatus::kFailed);
  CHECK(blocked.reason == "navigation-pose-unreachable: `base` would meet `drawer_mid`");
  CHECK_FALSE(ok(leave(kitchen_world(), kNear, "dLow")));
  CHECK(ok(leave(kitchen_world(), kFar, "dMid")));
  CHECK(ok(leave(kitchen_world(), kNear, "dTop")));  // above the body of the robot
}

TEST_CASE("a closed drawer, or a lower robot, leaves the way free") {
  CHECK(ok(leave(kitchen_world(), kNear, "")));

  WorldSpec low = kitchen_world();
  BodyShape& lower_body = body_of(low, "base").shapes.front();
  const BodyShape before = lower_body;
  lower_body.size_m.z() = 0.30;  // 0.03 to 0.33, below all drawers
  lower_body.p_BS.z() = 0.18;
  CHECK(ok(leave(low, kNear, "dMid")));
  lower_body = before;
  CHECK_FALSE(ok(leave(low, kNear, "dMid")));
}

TEST_CASE("a drawer that was opened can be closed again, and its load rides along") {
  Kitchen kitchen(kitchen_world());
  kitchen.start({{"spoon1.bottom", 0.53}, {"spoon1.x", 1.49}, {"spoon1.y", 0.88}});
  REQUIRE(ok(kitchen.open("dMid")));
  CHECK(kitchen.number("spoon1.x") ==
        doctest::Approx(1.49 - kitchen.number("dMid.q")).epsilon(0.01));
  REQUIRE(ok(kitchen.close("dMid")));
  CHECK(kitchen.number("dMid.q") < 0.02);
  CHECK(kitchen.number("spoon1.x") == doctest::Approx(1.49).epsilon(0.01));
}

TEST_CASE("the hand that holds the spoon pushes each drawer shut and keeps the spoon") {
  const std::pair<std::string, double> drawers[] = {{"dTop", 0.70}, {"dMid", 0.53}, {"dLow", 0.36}};
  for (const auto& [name, floor_m] : drawers) {
    const std::string drawer = name;
    CAPTURE(drawer);
    Kitchen kitchen(kitchen_world());
    kitchen.start({{"spoon1.bottom", floor_m}, {"spoon1.x", 1.49}, {"spoon1.y", 0.89}});
    REQUIRE(ok(kitchen.open(drawer)));
    REQUIRE(ok(kitchen.look(drawer)));
    REQUIRE(ok(kitchen.detect("spoon")));
    REQUIRE(ok(kitchen.pick("spoon1")));
    REQUIRE(ok(kitchen.close(drawer)));
    CHECK(kitchen.number(drawer + ".q") < 0.02);
    REQUIRE(ok(kitchen.park()));
    CHECK(kitchen.flag("spoon1.held_by.left"));
  }
}

}  // namespace
}  // namespace parallax::harness
