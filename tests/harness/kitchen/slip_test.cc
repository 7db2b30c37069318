#include <doctest/doctest.h>

#include <cmath>

#include "tests/harness/engine/engines.h"
#include "tests/harness/kitchen/kitchen_world.h"
#include "tests/support/deep.h"

namespace parallax::harness {
namespace {

/// Fate of a carton between the counter and the table.
enum class Fate { kNotLifted, kLostOnTheWay, kDelivered };

Fate carry(const WorldSpec& spec, double mass_kg, double speed_m_s = 0.6) {
  Kitchen kitchen(spec);
  kitchen.start({{"robot.x", 0.72}, {"robot.y", 0.06}, {"milk1.mass", mass_kg}});
  if (!ok(kitchen.lift_milk())) return Fate::kNotLifted;
  REQUIRE(ok(kitchen.park()));
  REQUIRE(
      ok(kitchen.act("drive", {{"place", std::string("bTable")}, {"max_speed_m_s", speed_m_s}})));
  return kitchen.flag("milk1.held") ? Fate::kDelivered : Fate::kLostOnTheWay;
}

constexpr double kFull_kg = 1.02, kNearlyFull_kg = 0.93, kHalf_kg = 0.6, kTooHeavy_kg = 1.2;

TEST_CASE("a full carton slips from the gripper on the way, a half full one does not") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const WorldSpec world = stepped_by(engine, kitchen_world());
    CHECK(carry(world, kNearlyFull_kg) == Fate::kDelivered);
    CHECK(carry(world, kFull_kg) == Fate::kLostOnTheWay);
    if (engine == EngineKind::kBullet && !test::is_deep()) continue;  // it takes long here
    CHECK(carry(world, kHalf_kg) == Fate::kDelivered);
    CHECK(carry(world, kTooHeavy_kg) == Fate::kNotLifted);
  }
}

TEST_CASE("a carton is lifted however it is turned against the robot") {
  for (const double yaw_rad : {-0.3, -0.1, 0.1, 0.3}) {
    CAPTURE(yaw_rad);
    Kitchen kitchen(kitchen_world());
    kitchen.start({{"robot.yaw", -0.1}, {"milk1.yaw", yaw_rad}, {"milk1.mass", 1.05}});
    CHECK(ok(kitchen.lift_milk()));
    const double in_grip_m = kitchen.number("left.z") - kitchen.number("milk1.bottom");
    CHECK(std::abs(in_grip_m - 0.165) < 0.003);
  }
}

TEST_CASE("more grip, more friction, less speed or an even floor keep the carton in the gripper") {
  WorldSpec grip = kitchen_world();
  body_of(grip, "milk1").grasp->effort_n = 40.0;
  CHECK(carry(grip, kFull_kg) == Fate::kDelivered);

  WorldSpec friction = kitchen_world();
  friction.friction.pairs[{"carton", "pad"}] = 0.6;
  CHECK(carry(friction, kFull_kg) == Fate::kDelivered);

  CHECK(carry(kitchen_world(), kFull_kg, 0.25) == Fate::kDelivered);

  WorldSpec even = kitchen_world();
  even.mobile->relief_amplitude_m = 0.0;
  CHECK(carry(even, kFull_kg) == Fate::kDelivered);
  even.mobile->relief_amplitude_m = kitchen_world().mobile->relief_amplitude_m;
  CHECK(carry(even, kFull_kg) == Fate::kLostOnTheWay);
}

TEST_CASE("regripping with more force saves a full carton") {
  Kitchen kitchen(kitchen_world());
  kitchen.start({{"robot.x", 0.72}, {"robot.y", 0.06}, {"milk1.mass", kFull_kg}});
  REQUIRE(ok(kitchen.lift_milk()));
  REQUIRE(ok(kitchen.act("regrip", {{"arm", std::string("left")}, {"effort_n", 40.0}})));
  REQUIRE(ok(kitchen.park()));
  REQUIRE(ok(kitchen.drive("bTable")));
  CHECK(kitchen.flag("milk1.held"));
  CHECK(kitchen.flag("milk1.held_by.left"));
  CHECK_FALSE(kitchen.flag("milk1.held_by.right"));
}

}  // namespace
}  // namespace parallax::harness
