#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "harness/engine/physics_world.h"
#include "harness/robot/mobile_robot.h"
#include "harness/world/angles.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {

inline WorldSpec solved(WorldSpec spec) {
  spec.solver.resting_joints = false;
  return spec;
}

/// A mobile robot with its servos, but without the actions that lead them.
class ServoRobot {
 public:
  explicit ServoRobot(const WorldSpec& spec) : world_(make_world(spec)), robot_(spec, *world_) {
    start();
  }

  void start() {
    REQUIRE_FALSE(world_->reset(default_placements(world_->layout()), 1).has_value());
    robot_.reset();
  }
  void run(double time_s) {
    for (int i = 0; i < std::lround(time_s / world_->timestep_s()); ++i) step();
  }
  void step() {
    const std::int64_t before = world_->statistics().joints_at_rest;
    robot_.drive_motors();
    REQUIRE(world_->step());
    at_rest_ = world_->statistics().joints_at_rest - before;
  }
  /// Number of joints that rested in the last step.
  std::int64_t at_rest() const { return at_rest_; }
  MobileRobot& robot() { return robot_; }
  Arm& left() { return *robot_.find_arm("left"); }
  Arm& right() { return *robot_.find_arm("right"); }
  PhysicsWorld& world() { return *world_; }
  Eigen::Vector3d at(std::string_view body) const {
    return world_->position(*world_->layout().find_body(body));
  }
  double yaw_rad(std::string_view body) const {
    return heading_rad(world_->rotation(*world_->layout().find_body(body)));
  }

 private:
  std::unique_ptr<PhysicsWorld> world_;
  MobileRobot robot_;
  std::int64_t at_rest_ = 0;
};

inline double distance_m(const ServoRobot& a, const ServoRobot& b, std::string_view body) {
  return (a.at(body) - b.at(body)).norm();
}

/// The same orders to a robot whose joints rest and to one whose joints are all solved.
struct Both {
  ServoRobot resting, all_solved;
  explicit Both(const WorldSpec& spec) : resting(spec), all_solved(solved(spec)) {}
  void tell(const std::function<void(ServoRobot&)>& order) {
    order(resting);
    order(all_solved);
  }
  void run(double time_s) {
    resting.run(time_s);
    all_solved.run(time_s);
    CHECK(all_solved.at_rest() == 0);
  }
  void check_same(double tolerance_m) const {
    for (const char* body : {"base", "torso", "left_palm", "left_near", "left_far", "right_palm",
                             "right_near", "right_far"}) {
      CAPTURE(body);
      CHECK(distance_m(resting, all_solved, body) < tolerance_m);
      CHECK(std::abs(wrapped(resting.yaw_rad(body) - all_solved.yaw_rad(body))) < tolerance_m);
    }
  }
};

}  // namespace parallax::harness
