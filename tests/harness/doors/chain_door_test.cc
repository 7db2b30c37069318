// Doors that an arm of joints opens: its links have to pass the leaf that the hand leads.

#include <doctest/doctest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/harness/doors/door_world.h"

namespace parallax::harness::test {
namespace {

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
