#include <doctest/doctest.h>

#include <cmath>

#include "harness/world/angles.h"
#include "tests/harness/kitchen/kitchen_world.h"
#include "tests/harness/robot/servo_robot.h"
#include "tests/harness/world/hand_made.h"

// Joints that are at rest are not solved. This must not change the result: references are a world
// of which all joints are solved, and Newton.

namespace parallax::harness {
namespace {

constexpr Motion kMotion{0.2, 0.5, 0.001, 10.0};

constexpr std::int64_t kAll = 6;  // wheels, lift, two arms, two fingers

TEST_CASE("a robot that is told nothing rests with all its joints, and stays where it is") {
  Both both(kitchen_world());
  const Eigen::Vector3d palm = both.resting.at("left_palm");
  both.run(1.0);
  CHECK(both.resting.at_rest() == kAll);
  CHECK((both.resting.at("left_palm") - palm).norm() < 1e-4);
  both.check_same(3e-6);
}

TEST_CASE("a robot of which one joint moves takes along what rests on it") {
  Both both(kitchen_world());
  both.run(0.5);
  std::int64_t at_rest = 0;
  SUBCASE("the torso") {
    both.tell([](ServoRobot& robot) { robot.robot().lift_to(0.2, kMotion); });
    both.run(0.5);
    at_rest = kAll - 1;
    CHECK(both.resting.at("right_far").z() > 1.15);
  }
  SUBCASE("the wheels") {
    both.tell([](ServoRobot& robot) { robot.robot().base().drive_to({0.3, 0.3}, kMotion); });
    both.run(1.0);
    at_rest = kAll - 1;
    CHECK(both.resting.at("left_palm").x() < 1.05);
  }
  SUBCASE("the wheels, on the spot") {
    both.tell([](ServoRobot& robot) { robot.robot().base().turn_to(1.0, kMotion); });
    both.run(1.0);
    at_rest = kAll - 1;
    CHECK(both.resting.yaw_rad("left_palm") > 0.1);
  }
  SUBCASE("an arm, while the other one rests") {
    both.tell([](ServoRobot& robot) {
      robot.left().move_tool_to(robot.left().tool() + Eigen::Vector3d(-0.1, 0.1, 0.1), kMotion);
      robot.left().turn_wrist_to(0.5, kMotion);
    });
    both.run(0.5);
    at_rest = kAll - 1;
    CHECK(std::abs(both.resting.left().wrist_rad()) > 0.05);
  }
  SUBCASE("a finger, on wheels that turn") {
    both.tell([](ServoRobot& robot) {
      robot.robot().base().turn_to(1.0, kMotion);
      robot.right().open_to(0.02, kMotion);
    });
    both.run(0.3);
    at_rest = kAll - 2;
    CHECK(both.resting.right().opening_m() ==
          doctest::Approx(both.all_solved.right().opening_m()).epsilon(1e-3));
  }
  CHECK(both.resting.at_rest() == at_rest);
  both.check_same(1e-5);
  // And comes to rest again.
  both.tell([](ServoRobot& robot) {
    robot.robot().brake_all();
    robot.right().open_to(robot.right().opening_m(), kMotion);
  });
  both.run(1.5);
  CHECK(both.resting.at_rest() == kAll);
  both.check_same(2e-5);
}

TEST_CASE("a flap that is hinged at the torso rests and moves like the rest") {
  WorldSpec spec = kitchen_world();
  BodySpec flap = box_body("flap", {0.2, 0.02, 0.1}, {0.60, -0.22, 1.3}, 0.5);
  flap.material = "robot";
  spec.bodies.push_back(flap);
  JointSpec joint;
  joint.name = "flap_hinge";
  joint.type = JointType::kHinge;
  joint.parent = "torso";
  joint.child = "flap";
  joint.axis_W = Eigen::Vector3d::UnitZ();
  joint.p_WA = {0.70, -0.22, 1.3};
  joint.max_torque_nm = 5.0;
  joint.low_rad = -1.0;
  joint.high_rad = 1.0;
  spec.joints.push_back(joint);
  Both both(spec);
  both.run(0.5);
  CHECK(both.resting.at_rest() == kAll + 1);
  both.tell([](ServoRobot& robot) { robot.robot().base().turn_to(0.5, kMotion); });
  both.run(0.5);
  CHECK(both.resting.at_rest() == kAll);
  both.tell([](ServoRobot& robot) {
    PhysicsWorld& world = robot.world();
    world.set_hinge_motor(*world.layout().find_hinge("flap_hinge"), 0.5, 5.0);
  });
  both.run(0.5);
  CHECK(both.resting.at_rest() == kAll - 1);
  const auto angle = [](ServoRobot& robot) {
    return robot.world().hinge_angle_rad(*robot.world().layout().find_hinge("flap_hinge"));
  };
  CHECK(angle(both.resting) == doctest::Approx(0.25).epsilon(0.01));
  CHECK(std::abs(angle(both.resting) - angle(both.all_solved)) < 1e-5);
  both.run(4.0);  // against its stop
  CHECK(angle(both.resting) == doctest::Approx(1.0).epsilon(0.01));
  CHECK((both.resting.at("flap") - both.all_solved.at("flap")).norm() < 1e-4);
  both.check_same(2e-5);
}

TEST_CASE("wheels push the mass of all that rests on them, and turn its moment of inertia") {
  WorldSpec spec = kitchen_world();
  spec.mobile->relief_amplitude_m = 0.0;
  double mass_kg = 0.0;
  for (const char* body : {"base", "torso", "left_palm", "left_near", "left_far", "right_palm",
                           "right_near", "right_far"}) {
    WorldSpec copy = spec;
    mass_kg += body_of(copy, body).mass_kg;
  }
  Both both(spec);
  both.run(0.5);
  constexpr double kTime_s = 0.2;
  const Motion too_fast{5.0, 1e4, 0.001, 10.0};
  SUBCASE("the mass") {
    const double start_m = both.resting.at("base").x();
    both.tell([&](ServoRobot& robot) {
      robot.robot().base().drive_to(robot.robot().base().pose().p - Eigen::Vector2d(9.0, 0.0),
                                    too_fast);
    });
    both.run(kTime_s);
    const double force_n = 400.0;  // of the wheels
    // The engine's way is longer by half a step.
    const double way_m = 0.5 * force_n / mass_kg * kTime_s * (kTime_s + spec.solver.timestep_s);
    CHECK(start_m - both.resting.at("base").x() == doctest::Approx(way_m).epsilon(0.002));
  }
  SUBCASE("the moment of inertia") {
    both.tell([&](ServoRobot& robot) { robot.robot().base().turn_to(3.0, too_fast); });
    both.run(kTime_s);
    CHECK(both.resting.yaw_rad("base") > 0.05);
  }
  CHECK(both.resting.at_rest() == kAll - 1);
  both.check_same(2e-4);
}

TEST_CASE("a parked arm that something falls on gives way as if it had never rested") {
  WorldSpec spec = kitchen_world();
  BodySpec weight = box_body("weight", {0.1, 0.1, 0.1}, {1.12, -0.09, 2.00}, 60.0);
  weight.material = "wood";
  spec.bodies.push_back(weight);
  Both both(spec);
  const double before_m = both.resting.at("right_palm").z();
  both.run(0.35);
  CHECK(both.resting.at_rest() == kAll);
  double deepest_m = 0.0, apart_m = 0.0;
  for (int i = 0; i < 150; ++i) {
    both.run(both.resting.world().timestep_s());
    deepest_m = std::max(deepest_m, before_m - both.all_solved.at("right_palm").z());
    apart_m = std::max(apart_m, distance_m(both.resting, both.all_solved, "right_palm"));
  }
  CHECK(deepest_m > 0.01);
  CHECK(apart_m < 0.02 * deepest_m);
}

TEST_CASE("an arm that something lies on does not rest, the rest of the robot does") {
  WorldSpec spec = kitchen_world();
  BodySpec thing = box_body("thing", {0.04, 0.04, 0.02}, {1.12, -0.09, 1.246}, 0.1);
  thing.material = "wood";
  spec.bodies.push_back(thing);
  ServoRobot robot(spec);
  robot.run(1.0);
  CHECK(robot.at_rest() == kAll - 2);  // not the palm, not its finger
}

TEST_CASE("a base at rest slides when an arm pushes harder than its wheels hold") {
  WorldSpec spec = kitchen_world();
  joint_of(spec, "wheels").max_force_n = 100.0;  // the arm has 300
  Both both(spec);
  both.run(0.5);
  const auto reach = [](const Eigen::Vector3d& by) {
    return
        [by](ServoRobot& robot) { robot.left().move_tool_to(robot.left().tool() + by, kMotion); };
  };
  both.tell(reach({0.0, 0.0, -0.5}));
  both.run(4.0);
  const Eigen::Vector3d start = both.all_solved.at("base");
  both.check_same(1e-5);
  both.tell(reach({1.0, 0.0, 0.0}));  // into the side of the counter
  both.run(2.0);
  const double slid_m = (both.all_solved.at("base") - start).norm();
  CHECK(slid_m > 0.01);
  CHECK((both.resting.at("base") - both.all_solved.at("base")).norm() < 0.02 * slid_m);
}

std::uint64_t digest_of_a_run(ServoRobot& robot) {
  robot.start();
  robot.run(0.1);
  robot.robot().lift_to(0.2, kMotion);
  robot.run(0.3);
  robot.robot().base().turn_to(0.5, kMotion);
  robot.run(0.3);
  robot.right().open_to(0.02, kMotion);
  robot.run(0.3);
  return robot.world().digest();
}

TEST_CASE("a reset while joints rest leaves no trace") {
  ServoRobot fresh(kitchen_world());
  const std::uint64_t expected = digest_of_a_run(fresh);
  ServoRobot used(kitchen_world());
  CHECK(digest_of_a_run(used) == expected);
  CHECK(digest_of_a_run(used) == expected);
  // Left with everything at rest, with the torso on its way, with a finger on wheels that turn.
  used.run(4.0);
  CHECK(used.at_rest() == kAll);
  CHECK(digest_of_a_run(used) == expected);
  used.start();
  used.run(0.1);
  used.robot().lift_to(0.2, kMotion);
  used.run(0.1);
  CHECK(digest_of_a_run(used) == expected);
  used.robot().base().turn_to(-0.5, kMotion);
  used.left().open_to(0.02, kMotion);
  used.run(0.1);
  CHECK(digest_of_a_run(used) == expected);
}

TEST_CASE("a carried carton arrives where it does when all joints are solved") {
  Kitchen resting(kitchen_world()), all_solved(solved(kitchen_world()));
  for (Kitchen* kitchen : {&resting, &all_solved}) {
    kitchen->start({{"milk1.mass", 0.5}});
    kitchen->carry_milk();
    REQUIRE(
        ok(kitchen->act("place", {{"arm", std::string("left")}, {"place", std::string("pt1")}})));
  }
  for (const char* name : {"milk1.x", "milk1.y", "milk1.bottom", "robot.x", "robot.y"}) {
    CAPTURE(name);
    CHECK(std::abs(resting.number(name) - all_solved.number(name)) < 0.002);
  }
  const StepStatistics& statistics = resting.simulator().statistics();
  CHECK(statistics.joints_at_rest > 2 * statistics.steps);
  CHECK(all_solved.simulator().statistics().joints_at_rest == 0);
}

}  // namespace
}  // namespace parallax::harness
