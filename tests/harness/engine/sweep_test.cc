#include "harness/engine/sweep.h"

#include <doctest/doctest.h>

#include <cmath>

#include "harness/engine/ode_world.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

const Eigen::Vector3d kHere = Eigen::Vector3d::Zero();
const Eigen::Vector3d kX = Eigen::Vector3d::UnitX(), kZ = Eigen::Vector3d::UnitZ();
constexpr double kStep_m = 0.01;

/// A cart of 0.2 m whose front is 0.85 m before a wall.
WorldSpec lane_spec() {
  return world_of({box_body("cart", {0.2, 0.2, 0.2}, {0.0, 0.0, 0.3}, 1.0),
                   box_body("wall", {0.1, 2.0, 1.0}, {1.0, 0.0, 0.5})});
}

struct Lane {
  explicit Lane(const WorldSpec& spec = lane_spec()) : world(spec) {}
  BodyMask mask(std::initializer_list<std::string_view> names) const {
    return mask_of(world.layout(), names);
  }
  Sweep cart(double tolerance_m = 0.0) const {
    return {world, mask({"cart"}), mask({}), tolerance_m};
  }
  OdeWorld world;
};

TEST_CASE("a straight sweep ends at what stands in the way") {
  const Lane lane;
  const auto hit = lane.cart().along(kHere, 2.0 * kX, kStep_m);
  REQUIRE(hit.has_value());
  CHECK(hit->part == "cart");
  CHECK(hit->obstacle == "wall");
  CHECK(hit->way_m >= 0.85 - 1e-9);
  CHECK(hit->way_m <= 0.85 + kStep_m + 1e-9);
  CHECK_FALSE(lane.cart().along(kHere, 0.84 * kX, kStep_m).has_value());
  CHECK_FALSE(lane.cart().along(kHere, -2.0 * kX, kStep_m).has_value());
}

TEST_CASE("both ends of a sweep are looked at, however long the step") {
  const Lane lane;
  CHECK(lane.cart().along(kHere, 0.9 * kX, 100.0).has_value());
  CHECK(lane.cart().along(0.9 * kX, -0.9 * kX, 100.0).has_value());
  CHECK_FALSE(lane.cart().along(kHere, 2.0 * kX, 100.0).has_value());  // beyond the wall
  CHECK_FALSE(lane.cart().along(kHere, kHere, kStep_m).has_value());
}

TEST_CASE("the floor is an obstacle, too") {
  const Lane lane;
  const auto hit = lane.cart().along(kHere, -0.5 * kZ, kStep_m);
  REQUIRE(hit.has_value());
  CHECK(hit->obstacle == "floor");
  CHECK(hit->way_m == doctest::Approx(0.21).epsilon(0.06));
}

TEST_CASE("a tolerance lets shapes overlap, a negative one asks for room") {
  const Lane lane;
  const auto way_m = [&](double tolerance_m) {
    return lane.cart(tolerance_m).along(kHere, 2.0 * kX, 0.001)->way_m;
  };
  CHECK(way_m(0.03) == doctest::Approx(0.88).epsilon(0.002));
  CHECK(way_m(0.0) == doctest::Approx(0.85).epsilon(0.002));
  CHECK(way_m(-0.05) == doctest::Approx(0.80).epsilon(0.002));
}

TEST_CASE("what is ignored, moves along or does not collide is in nobody's way") {
  const Lane lane;
  const Sweep past(lane.world, lane.mask({"cart"}), lane.mask({"wall"}), 0.0);
  CHECK_FALSE(past.along(kHere, 2.0 * kX, kStep_m).has_value());
  const Sweep together(lane.world, lane.mask({"cart", "wall"}), lane.mask({}), 0.0);
  CHECK_FALSE(together.along(kHere, 2.0 * kX, kStep_m).has_value());

  WorldSpec spec = lane_spec();
  spec.bodies.front().collides = false;
  const Lane ghost(spec);
  CHECK_FALSE(ghost.cart().along(kHere, 2.0 * kX, kStep_m).has_value());
}

TEST_CASE("a sweep starts from where the bodies stand when it is made") {
  Lane lane;
  auto placements = default_placements(lane.world.layout());
  placements[lane.world.layout().find_body("cart")->index()].p_WB.x() = 0.5;
  REQUIRE_FALSE(lane.world.reset(placements, 1).has_value());
  CHECK(lane.cart().along(kHere, kX, 0.001)->way_m == doctest::Approx(0.35).epsilon(0.01));
}

TEST_CASE("boxes of a body are turned as the body is") {
  BodySpec bar = box_body("bar", {1.0, 0.1, 0.1}, {0.0, 0.0, 0.3}, 1.0);
  bar.yaw_rad = 0.5 * M_PI;
  BodySpec own = bar;  // the same by the turn of its only box
  own.yaw_rad = 0.0;
  own.shapes.front().yaw_rad = 0.5 * M_PI;
  for (const BodySpec& body : {bar, own}) {
    const OdeWorld world(world_of({body, box_body("post", {0.1, 0.1, 1.0}, {1.0, 0.4, 0.5})}));
    const Sweep sweep(world, mask_of(world.layout(), {"bar"}), mask_of(world.layout(), {}), 0.0);
    const auto hit = sweep.along(kHere, 2.0 * kX, 0.001);
    REQUIRE(hit.has_value());
    CHECK(hit->way_m == doctest::Approx(0.9).epsilon(0.002));
  }
}

TEST_CASE("a turn meets what stands in its circle") {
  const OdeWorld world(world_of({box_body("bar", {1.0, 0.1, 0.1}, {0.0, 0.0, 0.3}, 1.0),
                                 box_body("post", {0.1, 0.1, 1.0}, {0.0, 0.45, 0.5})}));
  const Sweep sweep(world, mask_of(world.layout(), {"bar"}), mask_of(world.layout(), {}), 0.0);
  const auto hit = sweep.turning(kHere, kHere, 0.5 * M_PI, 0.02);
  REQUIRE(hit.has_value());
  CHECK(hit->part == "bar");
  CHECK(hit->obstacle == "post");
  CHECK_FALSE(sweep.turning(kHere, kHere, 0.5, 0.02).has_value());
  // Half a turn passes the post although it is free at both ends.
  CHECK(sweep.turning(kHere, kHere, -M_PI, 0.02).has_value());
  CHECK_FALSE(sweep.turning(kHere, kHere, -M_PI, 100.0).has_value());
  // Shifted away first, or turned about its right end: downwards and upwards.
  CHECK_FALSE(sweep.turning(-2.0 * kX, -2.0 * kX, 0.5 * M_PI, 0.02).has_value());
  CHECK_FALSE(sweep.turning(kHere, 0.5 * kX, 0.5 * M_PI, 0.02).has_value());
  CHECK(sweep.turning(kHere, 0.5 * kX, -0.5 * M_PI, 0.02).has_value());
}

}  // namespace
}  // namespace parallax::harness
