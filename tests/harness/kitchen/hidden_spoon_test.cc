#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/harness/engine/engines.h"
#include "tests/harness/kitchen/kitchen_world.h"
#include "tests/support/deep.h"

namespace parallax::harness {
namespace {

/// The spoon in the middle drawer at (x, y) of the drawer's frame, seen and taken from a stance.
struct Attempt {
  bool seen = false, taken = false;
  std::string reason;
};

Attempt fetch(const WorldSpec& spec, double robot_x_m, double robot_y_m, double x_d_m,
              double y_d_m) {
  Kitchen kitchen(spec);
  kitchen.start({{"robot.x", robot_x_m},
                 {"robot.y", robot_y_m},
                 {"spoon1.x", 1.54 + x_d_m},
                 {"spoon1.y", 0.90 + y_d_m},
                 {"spoon1.bottom", 0.53}});
  REQUIRE(ok(kitchen.open("dMid")));
  REQUIRE(ok(kitchen.park()));
  REQUIRE(ok(kitchen.look("dMid")));
  Attempt attempt;
  const Outcome seen = kitchen.detect("spoon");
  attempt.seen = ok(seen);
  CHECK(kitchen.flag("spoon1.perceived") == attempt.seen);
  const Outcome taken = kitchen.pick("spoon1");
  attempt.taken = ok(taken);
  attempt.reason = attempt.seen ? taken.reason : seen.reason;
  return attempt;
}

TEST_CASE("a spoon in the middle of the drawer is seen and taken from every stance") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    // Bullet takes some twenty times as long here as ODE.
    const bool is_brief = engine == EngineKind::kBullet && !test::is_deep();
    for (const double d : is_brief ? std::vector{0.06} : std::vector{0.0, 0.06, 0.12}) {
      const Attempt attempt = fetch(stepped_by(engine, kitchen_world()), 0.66 + d, d, -0.05, 0.0);
      CAPTURE(attempt.reason);
      CHECK(attempt.seen);
      CHECK(attempt.taken);
    }
  }
}

TEST_CASE("a spoon in a far corner is out of the camera's cone, and in it with a wider one") {
  const Attempt narrow = fetch(kitchen_world(), 0.78, 0.12, -0.22, 0.115);
  CHECK_FALSE(narrow.seen);
  CHECK_FALSE(narrow.taken);
  CHECK(narrow.reason.starts_with("object-not-found"));

  WorldSpec wide = kitchen_world();
  wide.mobile->camera.half_angle_rad = 0.5;
  CHECK(fetch(wide, 0.78, 0.12, -0.22, 0.115).seen);
}

TEST_CASE("where a spoon is believed to be does not depend on how much of it is in sight") {
  for (const double y_m : {0.80, 0.90, 1.00}) {
    Kitchen kitchen(kitchen_world());
    kitchen.start({{"spoon1.x", 1.40}, {"spoon1.y", y_m}, {"spoon1.bottom", 0.53}});
    REQUIRE(ok(kitchen.open("dMid")));
    REQUIRE(ok(kitchen.look("dMid")));
    const Outcome seen = kitchen.detect("spoon");
    REQUIRE(ok(seen));
    CHECK(std::abs(kitchen.number("spoon1.seen.x") - kitchen.number("spoon1.x")) < 0.003);
    CHECK(std::abs(kitchen.number("spoon1.seen.y") - kitchen.number("spoon1.y")) < 0.003);
  }
}

TEST_CASE("a spoon at the back is seen but cannot be taken where furniture is above it") {
  const Attempt attempt = fetch(kitchen_world(), 0.72, 0.06, 0.20, 0.0);
  CAPTURE(attempt.reason);
  CHECK(attempt.seen);
  CHECK_FALSE(attempt.taken);
  CHECK(attempt.reason.starts_with("manipulation-pose-unreachable"));
}

TEST_CASE("what is seen from outside the reach is not taken, and is with a longer arm") {
  WorldSpec low = kitchen_world();
  for (ArmSpec& arm : low.mobile->arms) arm.max_reach_m = 0.80;
  const Attempt attempt = fetch(low, 0.66, 0.0, -0.05, 0.1);
  CHECK_FALSE(attempt.taken);
  CHECK(fetch(kitchen_world(), 0.66, 0.0, -0.05, 0.1).taken);
}

/// Number of corners of a spoon's start region in the middle drawer that fail, from two corners of
/// the robot's.
int failures(const std::array<double, 2>& x_d_m, const std::array<double, 2>& y_d_m) {
  int failed = 0;
  for (const double x : x_d_m) {
    for (const double y : y_d_m) {
      for (const auto& [robot_x_m, robot_y_m] : {std::pair{0.66, 0.12}, std::pair{0.78, 0.0}}) {
        if (!fetch(kitchen_world(), robot_x_m, robot_y_m, x, y).taken) ++failed;
      }
    }
  }
  return failed;
}

TEST_CASE("a finer region of the spoon has no place where the model is wrong, the coarse one has") {
  // The start regions of the scenarios: plan 2 keeps to the middle, plan 3 takes the whole drawer.
  CHECK(failures({-0.10, 0.0}, {-0.05, 0.03}) == 0);
  CHECK(failures({-0.22, 0.22}, {-0.115, 0.115}) > 0);
}

}  // namespace
}  // namespace parallax::harness
