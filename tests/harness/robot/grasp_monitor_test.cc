#include "harness/robot/grasp_monitor.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "harness/engine/ode_world.h"
#include "tests/harness/world/fetch_world.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

constexpr double kTool_z_m = 0.24;  // of the pads' middle by default

/// The robot of the fetch world with the box, which nothing pulls down, between its pads.
WorldSpec between_pads() {
  WorldSpec spec = fetch_world();
  for (BodySpec& body : spec.bodies) {
    if (body.name != "box") continue;
    body.p_WB = {0.5, 0.0, kTool_z_m};
    body.gravity = false;
  }
  return spec;
}

struct Grasp {
  explicit Grasp(const WorldSpec& spec)
      : world(spec), monitor(spec, world), box(*world.layout().find_body("box")) {
    world.reset(default_placements(world.layout()), 1);
    monitor.reset();
  }

  bool both_pads() const { return world.touch(box).near_pad() && world.touch(box).far_pad(); }
  /// One timestep with the far pad pressing towards the near one, or leaving it.
  void step(bool closing) {
    world.set_motor(*world.layout().find_slider("finger"), closing ? -0.1 : 0.1, 20.0);
    REQUIRE(world.step());
    monitor.update();
  }
  /// Timesteps of squeezing until it is held; 0 if it never is.
  int steps_until_held(int most) {
    for (int i = 1; i <= most; ++i) {
      step(true);
      if (monitor.held(box)) return i;
    }
    return 0;
  }

  OdeWorld world;
  GraspMonitor monitor;
  BodyId box;
};

TEST_CASE("a body is held once both pads have touched it for as long as the world says") {
  Grasp grasp(between_pads());
  CHECK_FALSE(grasp.monitor.held(grasp.box));
  int touching = 0, longest_unheld = 0;
  for (int i = 0; i < 1000 && !grasp.monitor.held(grasp.box); ++i) {
    longest_unheld = std::max(longest_unheld, touching);
    grasp.step(true);
    touching = grasp.both_pads() ? touching + 1 : 0;
  }
  CHECK(grasp.monitor.held(grasp.box));
  CHECK(touching == 100);  // 0.2 s of 2 ms each
  CHECK(longest_unheld == 99);
  CHECK(grasp.monitor.held_by(0, grasp.box));
  CHECK(grasp.monitor.held_body(0) == grasp.box);

  for (int i = 0; i < 100 && grasp.both_pads(); ++i) grasp.step(false);
  CHECK_FALSE(grasp.both_pads());
  CHECK_FALSE(grasp.monitor.held(grasp.box));
  CHECK_FALSE(grasp.monitor.held_body(0).has_value());
}

TEST_CASE("a reset forgets what was held") {
  Grasp grasp(between_pads());
  REQUIRE(grasp.steps_until_held(1000) > 0);
  grasp.monitor.reset();
  CHECK_FALSE(grasp.monitor.held(grasp.box));
  CHECK(grasp.steps_until_held(1000) == 100);
}

TEST_CASE("what hangs too low over something is not held") {
  WorldSpec spec = between_pads();
  const double bottom_m = kTool_z_m - 0.035;
  SUBCASE("a shelf right below") {
    spec.bodies.push_back(box_body("shelf", {0.3, 0.04, 0.02}, {0.5, 0.0, bottom_m - 0.015}));
    Grasp grasp(spec);
    CHECK(grasp.monitor.clearance_m(grasp.box) == doctest::Approx(0.005));
    CHECK(grasp.steps_until_held(600) == 0);
    CHECK(grasp.both_pads());
  }
  SUBCASE("a shelf far enough below") {
    spec.bodies.push_back(box_body("shelf", {0.3, 0.04, 0.02}, {0.5, 0.0, bottom_m - 0.03}));
    Grasp grasp(spec);
    CHECK(grasp.monitor.clearance_m(grasp.box) == doctest::Approx(0.02));
    CHECK(grasp.steps_until_held(600) > 0);
  }
}

TEST_CASE("clearance is measured to the highest thing below, without the robot") {
  WorldSpec spec = between_pads();
  const double bottom_m = kTool_z_m - 0.035;
  Grasp bare(spec);
  CHECK(bare.monitor.clearance_m(bare.box) == doctest::Approx(bottom_m));
  spec.bodies.push_back(box_body("low", {0.02, 0.02, 0.1}, {0.5, 0.0, 0.05}));
  spec.bodies.push_back(box_body("high", {0.02, 0.02, 0.15}, {0.52, 0.0, 0.075}));
  spec.bodies.push_back(box_body("beside", {0.02, 0.02, 0.2}, {0.6, 0.3, 0.1}));
  spec.bodies.push_back(box_body("above", {0.02, 0.02, 0.02}, {0.5, 0.0, 0.8}));
  spec.bodies.push_back(box_body("picture", {0.5, 0.5, 0.2}, {0.5, 0.0, 0.1}));
  spec.bodies.back().collides = false;
  Grasp among(spec);
  CHECK(among.monitor.clearance_m(among.box) == doctest::Approx(bottom_m - 0.15));
}

TEST_CASE("a world without a robot holds nothing") {
  const WorldSpec spec = world_of({box_body("box", {0.1, 0.1, 0.1}, {0.0, 0.0, 0.5}, 1.0)});
  OdeWorld world(spec);
  GraspMonitor monitor(spec, world);
  REQUIRE(world.step());
  monitor.update();
  CHECK_FALSE(monitor.held(*world.layout().find_body("box")));
}

}  // namespace
}  // namespace parallax::harness
