// Premises of proofs about the hand: how closely its parts reach their commanded pose, and how
// exactly a camera without errors sees.

#include <doctest/doctest.h>

#include <cmath>

#include "harness/engine/ode_world.h"
#include "harness/geometry_proof/hand_shapes.h"
#include "harness/geometry_proof/sight_error.h"
#include "harness/robot/mobile_robot.h"
#include "harness/sampling/sampler.h"
#include "tests/harness/kitchen/kitchen_world.h"

namespace parallax::harness {
namespace {

TEST_CASE("a hand that is at rest has turned and opened as it was told, and is one piece") {
  const WorldSpec& spec = kitchen_world();
  OdeWorld world(spec);
  MobileRobot robot(spec, world);
  robot.reset();
  Arm& arm = robot.arms().front();
  const auto heights = [&] {
    std::vector<double> all;
    for (const BodyId id : arm.bodies()) all.push_back(world.position(id).z() - arm.tool().z());
    return all;
  };
  const std::vector<double> as_made = heights();
  const CounterRng rng({1, 6, {}, 0, 0});
  double off_m = 0.0;
  for (std::uint64_t n = 0; n < 6; ++n) {
    const double wrist = 3.0 * rng.uniform(4 * n) - 1.5;
    const double opening = arm.spec().opening_m * (0.1 + 0.9 * rng.uniform(4 * n + 1));
    arm.turn_wrist_to(wrist, {1.5, 4.0, kWristTolerance_rad, 10.0});
    arm.open_to(opening, {0.10, 0.5, kFingerTolerance_m, 10.0});
    arm.move_tool_to(arm.tool() + Eigen::Vector3d(0.0, 0.0, n % 2 == 0 ? -0.3 : 0.3),
                     {0.25, 0.5, 0.001, 10.0});
    for (int step = 0; step < 20'000 && !(arm.tool_at_rest() && arm.finger_at_rest()); ++step) {
      robot.drive_motors();
      REQUIRE(world.step());
      const std::vector<double> now = heights();
      for (std::size_t i = 0; i < now.size(); ++i) {
        off_m = std::max(off_m, std::abs(now[i] - as_made[i]));
      }
    }
    REQUIRE(arm.tool_at_rest());
    REQUIRE(arm.finger_at_rest());
    CHECK(std::abs(arm.wrist_rad() - wrist) <= kWristTolerance_rad);
    CHECK(std::abs(arm.opening_m() - opening) <= kFingerTolerance_m);
  }
  CHECK(off_m < kJointRoom_m);
  MESSAGE("parts of the hand are off by up to " << off_m << " m");
}

TEST_CASE("what an exact camera sees lies no farther from the body than is said") {
  std::int64_t exact = 0, bounded = 0;
  for (std::uint64_t n = 1; n <= 24; ++n) {
    const CounterRng rng({n, 7, {}, 0, 0});
    const auto between = [&](std::uint64_t i, double low, double high) {
      return low + (high - low) * rng.uniform(i);
    };
    WorldSpec spec = kitchen_world();
    spec.mobile->camera.detection = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    BodySpec& spoon = body_of(spec, "spoon1");
    if (n % 3 != 0) {  // other spoons, with bowls of other sizes, also beside the handle's line
      spoon.shapes[1].size_m.x() = between(0, 0.012, 0.08);
      spoon.shapes[1].size_m.z() = between(1, 0.005, 0.06);
      spoon.shapes[1].p_BS.z() = 0.5 * spoon.shapes[1].size_m.z() - 0.0095;
      spoon.shapes[1].p_BS.x() = n % 3 == 1 ? 0.0 : between(2, -0.02, 0.02);
    }
    const State start = {{"spoon1.x", between(3, 1.36, 1.56)},  {"spoon1.y", between(4, -0.1, 0.1)},
                         {"spoon1.yaw", between(5, -3.0, 3.0)}, {"spoon1.bottom", 0.851},
                         {"robot.x", between(6, 0.55, 0.75)},   {"robot.y", between(7, -0.3, 0.3)},
                         {"robot.yaw", between(8, -0.3, 0.3)}};
    StartCuboid region;
    for (const auto& [name, value] : start) {
      region.dimensions.push_back({name, {*as_number(value), *as_number(value), false}});
    }
    const WorldLayout layout = lay_out(spec);
    KnownState state = state_at_start(spec, layout, region);
    state.slack.drift_m = 0.002, state.slack.drift_rad = 0.005;
    const ProofScene scene(spec, layout, region, state);
    const SightError error = sight_error(scene, scene.whole(), *layout.find_body("spoon1"), 9, 5);
    Kitchen kitchen(spec);
    if (!ok(kitchen.simulator().reset(start, n))) continue;
    const std::string x = "target.x", y = "target.y", z = "target.z";
    if (!ok(kitchen.act(
            "look",
            {{x, kitchen.number("spoon1.x")}, {y, kitchen.number("spoon1.y")}, {z, 0.86}})) ||
        !ok(kitchen.detect("spoon"))) {
      continue;
    }
    const double level = std::hypot(kitchen.number("spoon1.seen.x") - kitchen.number("spoon1.x"),
                                    kitchen.number("spoon1.seen.y") - kitchen.number("spoon1.y"));
    CAPTURE(n);
    CHECK(level <= error.level_m);
    // A body on the counter is seen to lie there.
    CHECK(std::abs(kitchen.number("spoon1.seen.bottom") - 0.85) <= error.height_m + 5e-4);
    ++(error.level_m < 1e-4 ? exact : bounded);
  }
  CHECK(exact + bounded > 10);
  CHECK(exact > 0);
}

}  // namespace
}  // namespace parallax::harness
