#include <doctest/doctest.h>

#include "harness/engine/ode_world.h"
#include "harness/robot/mobile_controller.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

const Eigen::Vector3d kFrom(0.0, 0.0, 0.3), kTo(1.0, 0.0, 0.3);
const Eigen::Vector3d kBack = -Eigen::Vector3d::UnitX();

/// A hand of 0.1 m at kFrom, among `furniture`.
class Hand {
 public:
  explicit Hand(std::vector<BodySpec> furniture)
      : world_(with_hand(std::move(furniture))),
        sweep_(world_, mask_of(world_.layout(), {"hand"}), mask_of(world_.layout(), {}), 0.0) {}

  ToolPath path(const Eigen::Vector3d& to, double ceiling_m,
                const Eigen::Vector3d& back = kBack) const {
    return find_tool_path(swept(sweep_, kFrom), kFrom, to, back, ceiling_m);
  }
  bool is_free(const ToolPath& path) const {
    Eigen::Vector3d last = kFrom;
    for (const Eigen::Vector3d& corner : path.corners) {
      if (sweep_.along(last - kFrom, corner - last, 0.005)) return false;
      last = corner;
    }
    return true;
  }

 private:
  static WorldSpec with_hand(std::vector<BodySpec> bodies) {
    bodies.push_back(box_body("hand", {0.1, 0.1, 0.1}, kFrom, 0.5));
    return world_of(std::move(bodies));
  }
  OdeWorld world_;
  Sweep sweep_;
};

BodySpec wall(double height_m) {
  return box_body("wall", {0.1, 2.0, height_m}, {0.5, 0.0, 0.5 * height_m});
}

TEST_CASE("where nothing is in the way, the way is straight") {
  const auto path = Hand({}).path(kTo, 1.0);
  REQUIRE(path.corners.size() == 1);
  CHECK(path.corners.front() == kTo);
  CHECK_FALSE(path.blocked.has_value());
}

TEST_CASE("a way over a wall goes up, across and down, as low as it will do") {
  const Hand hand({wall(0.5)});
  const auto path = hand.path(kTo, 1.5);
  REQUIRE(path.corners.size() == 3);
  CHECK(hand.is_free(path));
  CHECK(path.corners[0].head<2>() == kFrom.head<2>());
  CHECK(path.corners[1].head<2>() == kTo.head<2>());
  CHECK(path.corners[0].z() == path.corners[1].z());
  // The hand's lower face passes over the wall, and the next lower height, 0.1 m below, is not
  // free.
  CHECK(path.corners[0].z() >= 0.55);
  CHECK(path.corners[0].z() < 0.65);
  CHECK(path.corners[2] == kTo);
}

TEST_CASE("a hand under a board draws back before it goes up") {
  // The board hangs over the start and reaches 0.16 m behind it.
  const Hand hand({wall(0.5), box_body("board", {0.4, 1.0, 0.02}, {0.04, 0.0, 0.42})});
  const auto path = hand.path(kTo, 1.5);
  REQUIRE_FALSE(path.corners.empty());
  CHECK(hand.is_free(path));
  CHECK(path.corners.front().z() == kFrom.z());
  CHECK(path.corners.front().x() == doctest::Approx(-0.25));
  CHECK(path.corners.back() == kTo);
}

TEST_CASE("a goal in a bay is entered from its open side") {
  const Hand hand({box_body("ceiling", {0.6, 1.0, 0.02}, {1.1, 0.0, 0.45}), wall(0.3)});
  const auto path = hand.path({1.1, 0.0, 0.3}, 1.5);
  REQUIRE(path.corners.size() >= 3);
  CHECK(hand.is_free(path));
  const Eigen::Vector3d last_but_one = path.corners[path.corners.size() - 2];
  CHECK(last_but_one.x() < 0.8);  // before the ceiling's edge
  CHECK(last_but_one.z() == doctest::Approx(0.3));
}

TEST_CASE("a wall as high as the ceiling blocks, and is named") {
  const Hand hand({wall(2.0)});
  const auto path = hand.path(kTo, 1.0);
  CHECK(path.corners.empty());
  REQUIRE(path.blocked.has_value());
  CHECK(path.blocked->hit->part == "hand");
  CHECK(path.blocked->hit->obstacle == "wall");
}

TEST_CASE("a goal inside of something is not reached") {
  const auto path = Hand({wall(0.5)}).path({0.5, 0.0, 0.3}, 1.5);
  CHECK(path.corners.empty());
  CHECK(path.blocked->hit->obstacle == "wall");
}

TEST_CASE("a ceiling below both ends still allows the height of the ends") {
  const Hand hand({box_body("post", {0.1, 0.1, 0.5}, {0.5, 0.0, 0.25})});
  CHECK(hand.path(kTo, 0.0).corners.empty());
  CHECK(hand.path({1.0, 0.0, 0.7}, 0.0).corners.size() == 2);  // up first, then across
}

}  // namespace
}  // namespace parallax::harness
