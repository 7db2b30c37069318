// The opening of a gripper is the gap between its pads along the way of its finger.

#include "harness/robot/line_robot.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "harness/engine/jaws.h"
#include "harness/engine/ode_world.h"
#include "tests/harness/world/fetch_world.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

constexpr double kGap_m = 0.09;  // of fetch_world

/// The same hand with its pads turned about the palm by `yaw_rad`, and shifted against each other
/// across the way of the finger.
WorldSpec turned_hand(double yaw_rad, double shift_m) {
  WorldSpec spec = fetch_world();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d palm = body_of(spec, "palm").p_WB;
  for (const char* name : {"near_pad", "far_pad"}) {
    BodySpec& pad = body_of(spec, name);
    Eigen::Vector3d p = pad.p_WB - palm;
    if (pad.name == "far_pad") p.x() += shift_m;
    pad.p_WB = palm + turn * p;
    pad.yaw_rad = yaw_rad;
  }
  joint_of(spec, "finger").axis_W = turn * Eigen::Vector3d::UnitY();
  return spec;
}

TEST_CASE(
    "a hand opens as wide however it is turned, and wherever its pads stand beside each other") {
  for (const double yaw_rad : {0.0, 0.3, 0.25 * std::numbers::pi, 1.2, -2.0}) {
    for (const double shift_m : {0.0, 0.015}) {
      CAPTURE(yaw_rad);
      CAPTURE(shift_m);
      const WorldSpec spec = turned_hand(yaw_rad, shift_m);
      OdeWorld world(spec);
      const LineRobot robot(spec, world);
      CHECK(robot.opening_m() == doctest::Approx(kGap_m));
      CHECK(robot.finger_position_for(0.05) == doctest::Approx(0.05 - kGap_m));

      ArmSpec arm;
      arm.palm_body = "palm";
      arm.finger_joint = "finger";
      arm.near_pad_body = "near_pad";
      arm.far_pad_body = "far_pad";
      const Jaws jaws(arm, world);
      CHECK(jaws.opening_m(0.0) == doctest::Approx(kGap_m));
      CHECK(jaws.opening_limits_m().first == doctest::Approx(kGap_m - 0.085));
      CHECK(jaws.pad_line_P().isApprox(
          Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) * -Eigen::Vector3d::UnitY(), 1e-9));
    }
  }
}

TEST_CASE("the innermost face of a pad of several shapes counts, also where they are turned") {
  WorldSpec spec = turned_hand(0.7, 0.0);
  BodyShape lip{Eigen::Vector3d(0.02, 0.02, 0.01)};
  lip.p_BS = {0.0, 0.0, 0.03};  // 5 mm farther in, and out, than the pad
  body_of(spec, "near_pad").shapes.push_back(lip);
  OdeWorld world(spec);
  CHECK(LineRobot(spec, world).opening_m() == doctest::Approx(kGap_m - 0.005));
}

}  // namespace
}  // namespace parallax::harness
