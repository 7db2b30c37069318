#include <doctest/doctest.h>

#include <cmath>

#include "tests/harness/kitchen/kitchen_world.h"

namespace parallax::harness {
namespace {

TEST_CASE("driving ends at the place with its heading, arms still parked, from any start") {
  Kitchen kitchen(kitchen_world());
  for (const double d : {-0.07, 0.0, 0.07}) {
    kitchen.start({{"robot.x", 0.72 + d}, {"robot.y", 0.06 - d}, {"robot.yaw", d}});
    CHECK(kitchen.number("robot.yaw") == doctest::Approx(d));
    CHECK(kitchen.flag("left.parked"));
    REQUIRE(ok(kitchen.drive("bTable")));
    CHECK(std::abs(kitchen.number("robot.x") + 0.10) < 0.01);
    CHECK(std::abs(kitchen.number("robot.y") - 0.56) < 0.01);
    CHECK(std::abs(std::abs(kitchen.number("robot.yaw")) - M_PI) < 0.02);
    CHECK(kitchen.flag("left.parked"));
    CHECK(kitchen.flag("right.parked"));
  }
}

TEST_CASE("an item is set down where it was asked for") {
  Kitchen kitchen(kitchen_world());
  kitchen.start({{"milk1.mass", 0.5}});
  kitchen.carry_milk();
  REQUIRE(ok(kitchen.act("place", {{"arm", std::string("left")}, {"place", std::string("pt1")}})));
  CHECK(std::abs(kitchen.number("milk1.x") + 0.82) < 0.02);
  CHECK(std::abs(kitchen.number("milk1.y") - 0.475) < 0.02);
  CHECK(std::abs(kitchen.number("milk1.bottom") - 0.86) < 0.002);
  CHECK_FALSE(kitchen.flag("milk1.held"));
}

TEST_CASE("a robot that has driven away looks at nothing, also when it is back") {
  Kitchen kitchen(kitchen_world());
  kitchen.start({});
  REQUIRE(ok(kitchen.look("pw1")));
  REQUIRE(ok(kitchen.act("drive", {{"target.x", 0.70}, {"target.y", 0.06}})));
  CHECK(kitchen.text("robot.looking_at") == "pw1");  // still within the camera's cone
  REQUIRE(ok(kitchen.drive("bTable")));
  CHECK(kitchen.text("robot.looking_at").empty());
  REQUIRE(ok(kitchen.drive("bWork")));
  CHECK(kitchen.text("robot.looking_at").empty());
  CHECK_FALSE(ok(kitchen.detect("milk")));
}

TEST_CASE("parking does not brush what is carried against things on the counter") {
  // Beside the cereal, as far forward and turned as the starts allow.
  for (const double cereal_x_m : {1.41, 1.424, 1.44}) {
    CAPTURE(cereal_x_m);
    Kitchen kitchen(kitchen_world());
    kitchen.start({{"robot.x", 0.789},
                   {"robot.y", 0.029},
                   {"robot.yaw", -0.073},
                   {"cereal1.x", cereal_x_m},
                   {"cereal1.yaw", 0.185},
                   {"spoon1.x", 1.443},
                   {"spoon1.y", 0.871},
                   {"spoon1.yaw", -0.284}});
    REQUIRE(ok(kitchen.open("dTop")));
    REQUIRE(ok(kitchen.look("dTop")));
    REQUIRE(ok(kitchen.detect("spoon")));
    REQUIRE(ok(kitchen.pick("spoon1")));
    const double x_m = kitchen.number("cereal1.x");
    REQUIRE(ok(kitchen.park()));
    CHECK(kitchen.flag("spoon1.held"));
    CHECK(kitchen.number("cereal1.x") == doctest::Approx(x_m).epsilon(1e-4));
  }
}

TEST_CASE("what is let go falls to the floor") {
  Kitchen kitchen(kitchen_world());
  kitchen.start({{"milk1.mass", 0.5}});
  kitchen.carry_milk();
  REQUIRE(ok(kitchen.act("open-gripper", {{"arm", std::string("left")}})));
  CHECK(kitchen.number("milk1.bottom") < 0.05);
}

TEST_CASE("the torso lifts camera and arms and refuses heights beyond its stops") {
  Kitchen kitchen(kitchen_world());
  kitchen.start({});
  const double tool_m = kitchen.number("left.z");
  REQUIRE(ok(kitchen.act("move-torso", {{"height_m", 0.2}})));
  CHECK(kitchen.number("left.z") == doctest::Approx(tool_m + 0.2).epsilon(0.01));
  CHECK(kitchen.flag("left.parked"));
  CHECK_FALSE(ok(kitchen.act("move-torso", {{"height_m", 1.0}})));
}

TEST_CASE("unknown items are not picked up, and empty grippers place nothing") {
  Kitchen kitchen(kitchen_world());
  kitchen.start({});
  CHECK(kitchen.pick("milk1").reason.starts_with("object-not-found"));
  const Outcome placed =
      kitchen.act("place", {{"arm", std::string("left")}, {"place", std::string("pw1")}});
  CHECK(placed.reason.starts_with("object-not-held"));
}

TEST_CASE("every run after a reset with the same start gives the same bits, in any simulator") {
  const auto digest = [](Kitchen& kitchen) {
    kitchen.start({{"robot.x", 0.7}, {"spoon1.bottom", 0.53}, {"milk1.mass", 0.8}});
    REQUIRE(ok(kitchen.open("dMid")));
    REQUIRE(ok(kitchen.look("dMid")));
    kitchen.detect("spoon");
    kitchen.pick("spoon1");
    const State state = kitchen.simulator().state();
    return std::get<std::string>(state.find("digest")->second);
  };
  Kitchen first(kitchen_world()), second(kitchen_world());
  const std::string once = digest(first);
  CHECK(digest(first) == once);
  second.start({{"milk1.mass", 0.9}});
  CHECK(ok(second.drive("bTable")));
  CHECK(digest(second) == once);
}

}  // namespace
}  // namespace parallax::harness
