// Contacts that are left out between two sides must not carry anything: bodies stand, tip and slide
// just as with all contacts.

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "harness/engine/physics_world.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

/// A world with at most `per_side` contacts a side, at its start.
struct Scene {
  Scene(WorldSpec spec, std::optional<std::int64_t> per_side) {
    spec.solver.max_contacts_per_pair = 4;
    spec.solver.max_contacts_per_side = per_side;
    spec.solver.sleep_after_s = 100.0;  // never
    world = make_world(spec);
    REQUIRE_FALSE(world->reset(default_placements(world->layout()), 1).has_value());
  }
  void run(double time_s) {
    for (int i = 0; i < std::lround(time_s / world->timestep_s()); ++i) {
      const std::int64_t before = world->statistics().contacts;
      REQUIRE(world->step());
      contacts = world->statistics().contacts - before;
    }
  }
  Eigen::Vector3d at(const char* body) const {
    return world->position(*world->layout().find_body(body));
  }
  double tilt_rad(const char* body) const {
    const Eigen::Matrix3d R = world->rotation(*world->layout().find_body(body));
    return std::acos(std::min(1.0, R(2, 2)));
  }
  std::unique_ptr<PhysicsWorld> world;
  std::int64_t contacts = 0;  // of the last step
};

/// Twelve walls on the floor, as a bowl has them.
WorldSpec bowl() {
  BodySpec body = box_body("bowl", {0.01, 0.04, 0.06}, {0.0, 0.0, 0.03}, 0.3);
  body.shapes.clear();
  for (int i = 0; i < 12; ++i) {
    BodyShape wall{{0.005, 0.036, 0.06}};
    wall.yaw_rad = i * std::numbers::pi / 6.0;
    wall.p_BS = 0.07 * Eigen::Vector3d(std::cos(wall.yaw_rad), std::sin(wall.yaw_rad), 0.0);
    body.shapes.push_back(wall);
  }
  return world_of({body});
}

TEST_CASE("a bowl stands on a few of its corners as on all of them") {
  Scene all(bowl(), std::nullopt), few(bowl(), 6);
  all.run(1.0);
  few.run(1.0);
  CHECK(all.contacts == 48);
  CHECK(few.contacts == 6);
  CHECK((few.at("bowl") - all.at("bowl")).norm() < 1e-4);
  CHECK(few.tilt_rad("bowl") < 1e-3);
  few.run(5.0);
  CHECK(few.at("bowl").head<2>().norm() < 1e-4);
}

/// A plank of five blocks on a block that ends `beyond_m` before the plank's middle.
WorldSpec plank(double beyond_m) {
  BodySpec body = box_body("plank", {0.1, 0.1, 0.02}, {0.0, 0.0, 0.11}, 1.0);
  body.shapes.clear();
  for (int i = -2; i <= 2; ++i) {
    BodyShape block{{0.1, 0.1, 0.02}};
    block.p_BS = {0.1 * i, 0.0, 0.0};
    body.shapes.push_back(block);
  }
  return world_of({body, box_body("block", {0.5, 0.3, 0.1}, {-0.25 - beyond_m, 0.0, 0.05})});
}

TEST_CASE("a plank tips over an edge where its middle is beyond it, and stays where it is not") {
  for (const std::optional<std::int64_t> per_side : {std::optional<std::int64_t>(), {4}, {6}}) {
    CAPTURE(per_side.value_or(0));
    Scene stays(plank(-0.01), per_side), tips(plank(0.01), per_side);
    stays.run(1.0);
    tips.run(1.0);
    CHECK(stays.tilt_rad("plank") < 0.01);
    CHECK(tips.tilt_rad("plank") > 0.1);
  }
}

TEST_CASE("floor and wall are two sides") {
  WorldSpec spec = world_of({box_body("box", {0.1, 0.1, 0.1}, {0.0, 0.0, 0.05}, 1.0),
                             box_body("wall", {0.1, 0.3, 0.3}, {-0.0999, 0.0, 0.15})});
  Scene scene(spec, 4);
  scene.run(0.01);
  CHECK(scene.contacts == 8);
}

/// A sledge of six blocks that is pushed by a slider's motor over the floor.
WorldSpec sledge(double push_n) {
  BodySpec body = box_body("sledge", {0.1, 0.1, 0.05}, {0.0, 0.0, 0.025}, 2.0);
  body.shapes.clear();
  for (int i = 0; i < 6; ++i) {
    BodyShape block{{0.1, 0.1, 0.05}};
    block.p_BS = {0.1 * (i % 3 - 1), 0.1 * (i / 3) - 0.05, 0.0};
    body.shapes.push_back(block);
  }
  WorldSpec spec =
      world_of({body, box_body("pusher", {0.05, 0.2, 0.04}, {-0.1751, 0.0, 0.03}, 1.0)});
  spec.bodies.back().gravity = false;
  spec.friction.fallback = 0.3;
  JointSpec joint;
  joint.name = "push";
  joint.child = "pusher";
  joint.max_force_n = push_n;
  spec.joints.push_back(joint);
  return spec;
}

TEST_CASE("friction is that of the weight, however many contacts carry it") {
  const double needed_n = 0.3 * 2.0 * 9.81;
  for (const std::optional<std::int64_t> per_side : {std::optional<std::int64_t>(), {4}, {6}}) {
    CAPTURE(per_side.value_or(0));
    for (const double share : {0.95, 1.05}) {
      Scene scene(sledge(share * needed_n), per_side);
      scene.world->set_motor(*scene.world->layout().find_slider("push"), 1.0, share * needed_n);
      scene.run(1.0);
      if (share < 1.0) {
        CHECK(scene.at("sledge").x() < 0.002);
      } else {
        // The part of the push beyond friction accelerates sledge and pusher.
        const double way_m = 0.5 * (share - 1.0) * needed_n / 3.0;
        CHECK(scene.at("sledge").x() == doctest::Approx(way_m).epsilon(0.15));
      }
    }
  }
}

}  // namespace
}  // namespace parallax::harness
