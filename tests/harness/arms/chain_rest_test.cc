// Joints of an arm that is a chain rest as others do, also while its hand touches something, and
// the motors of those that move are not bounded while they have torque to spare. Neither may change
// the result: the same world with all joints solved and all motors bounded is the reference.

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/harness/arms/arm_robot.h"
#include "tests/harness/robot/servo_robot.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

constexpr Motion kSlow{0.2, 0.5, 0.001, 10.0};
constexpr std::int64_t kAllJoints =
    15;  // lift, two arms of six joints, two fingers; not the springs

/// A world with a block. Without a mass it is fixed.
WorldSpec with_block(const Eigen::Vector3d& size_m, const Eigen::Vector3d& p_W, double mass_kg) {
  WorldSpec spec = chain_warehouse();
  BodySpec block = box_body("block", size_m, p_W, mass_kg);
  block.material = "wood";
  spec.bodies.push_back(block);
  return spec;
}

TEST_CASE("a robot with chains that is told nothing rests with all joints but its springs") {
  Both both(chain_warehouse());
  const Eigen::Vector3d palm = both.resting.at("left_palm");
  both.run(1.0);
  CHECK(both.resting.at_rest() == kAllJoints);
  CHECK((both.resting.at("left_palm") - palm).norm() < 2e-4);
  both.check_same(1e-4);
}

TEST_CASE("a chain that moves takes nothing along that is not on it") {
  Both both(chain_warehouse());
  both.run(0.5);
  SUBCASE("the left arm") {
    both.tell([](ServoRobot& robot) {
      robot.left().move_tool_to(robot.left().tool() + Eigen::Vector3d(-0.05, 0.1, 0.1), kSlow);
    });
    both.run(0.5);
    CHECK(both.resting.at_rest() >= kAllJoints - 6);
    CHECK(both.resting.at_rest() < kAllJoints);
  }
  SUBCASE("the base") {
    both.tell([](ServoRobot& robot) { robot.robot().base().drive_to({-0.3, 0.0}, kSlow); });
    both.run(1.0);
    CHECK(both.resting.at("left_palm").x() < 0.35);
  }
  both.check_same(1e-4);
  both.tell([](ServoRobot& robot) { robot.robot().brake_all(); });
  both.run(1.5);
  CHECK(both.resting.at_rest() == kAllJoints);
  both.check_same(1e-4);
}

TEST_CASE("an arm at rest that something heavy falls on gives way as if it had never rested") {
  Both both(with_block({0.2, 0.2, 0.1}, {0.4, 0.2, 2.0}, 40.0));
  const double before_m = both.resting.at("left_palm").z();
  double deepest_m = 0.0, apart_m = 0.0;
  for (int i = 0; i < 300; ++i) {
    both.run(both.resting.world().timestep_s());
    deepest_m = std::max(deepest_m, before_m - both.all_solved.at("left_palm").z());
    apart_m = std::max(apart_m, distance_m(both.resting, both.all_solved, "left_palm"));
  }
  CHECK(deepest_m > 0.01);
  CHECK(apart_m < 0.02 * deepest_m);
}

TEST_CASE("a chain rests under a weight that takes less than half the torque of its motors") {
  // The weight lies on the palm, 0.4 m ahead of the shoulder and 0.12 m beside the wrist.
  for (const double mass_kg : {2.0, 8.0}) {
    CAPTURE(mass_kg);
    Both both(with_block({0.08, 0.1, 0.05}, {0.4, 0.13, 1.252}, mass_kg));
    both.run(2.0);
    CHECK(both.all_solved.at("block").z() > 1.22);  // it has not fallen off
    // All but the finger, and the pan, whose command swings by 1.5e-5 rad/s from step to step.
    CHECK((both.resting.at_rest() >= kAllJoints - 2) == (mass_kg < 5.0));
    both.check_same(2e-4);
  }
}

TEST_CASE("a chain at rest is not stronger than its motors: the base is pushed away by a wall") {
  WorldSpec spec = with_block({0.02, 0.6, 0.6}, {0.56, 0.2, 1.25}, 0.0);
  joint_of(spec, "wheels").max_force_n = 60.0;
  Both both(spec);
  both.run(0.3);
  both.tell([](ServoRobot& robot) {
    robot.left().move_tool_to(robot.left().tool() + Eigen::Vector3d(0.3, 0.0, 0.0), kSlow);
  });
  both.run(3.0);
  const double slid_m = std::abs(both.all_solved.at("base").x());
  CHECK(slid_m > 0.01);
  CHECK(distance_m(both.resting, both.all_solved, "base") < 0.02 * slid_m);
}

TEST_CASE("a crate that is carried by a chain arrives where it does when all joints are solved") {
  WorldSpec all_solved = chain_warehouse();
  all_solved.solver.resting_joints = false;
  Eigen::Vector3d held[2], placed[2];
  int i = 0;
  for (const WorldSpec& spec : {chain_warehouse(), all_solved}) {
    Robot robot(spec);
    robot.find("binA", "crate");
    REQUIRE(robot.pick("crate").status == SimStatus::kOk);
    REQUIRE(robot.act("park", {{"arm", std::string("left")}}).status == SimStatus::kOk);
    REQUIRE(robot.act("drive", {{"place", std::string("atShelf")}}).status == SimStatus::kOk);
    held[i] = robot.position("crate") - robot.position("left_palm");
    REQUIRE(robot
                .act("place", {{"arm", std::string("left")},
                               {"object", std::string("crate")},
                               {"place", std::string("slot1")}})
                .status == SimStatus::kOk);
    placed[i++] = robot.position("crate");
  }
  CHECK((held[0] - held[1]).norm() < 0.0005);
  CHECK((placed[0] - placed[1]).norm() < 0.0005);
}

std::uint64_t digest_of_moves(ServoRobot& robot) {
  robot.start();
  robot.run(0.2);
  robot.left().move_tool_to(robot.left().tool() + Eigen::Vector3d(0.0, 0.1, 0.1), kSlow);
  robot.run(0.3);
  robot.robot().base().turn_to(0.5, kSlow);
  robot.run(0.3);
  return robot.world().digest();
}

TEST_CASE("a reset while joints of a chain rest, or move, leaves no trace") {
  ServoRobot fresh(chain_warehouse());
  const std::uint64_t expected = digest_of_moves(fresh);
  ServoRobot used(chain_warehouse());
  CHECK(digest_of_moves(used) == expected);
  CHECK(digest_of_moves(used) == expected);
  used.run(4.0);
  CHECK(digest_of_moves(used) == expected);
  used.right().move_tool_to(used.right().tool() + Eigen::Vector3d(0.0, -0.1, 0.1), kSlow);
  used.run(0.1);
  CHECK(digest_of_moves(used) == expected);
}

}  // namespace
}  // namespace parallax::harness
