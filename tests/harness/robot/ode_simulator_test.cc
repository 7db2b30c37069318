#include "harness/robot/ode_simulator.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "tests/harness/world/fetch_world.h"

namespace parallax::harness {
namespace {

constexpr double kLimit_s = 60.0;

Outcome go(OdeSimulator& simulator, double x_m) {
  return simulator.act("going", {{"target.x", x_m}}, kLimit_s);
}
Outcome pick(OdeSimulator& simulator) {
  return simulator.act("picking-up", {{"object", std::string("box")}}, kLimit_s);
}
Outcome place(OdeSimulator& simulator, double x_m) {
  return simulator.act("placing", {{"target.x", x_m}}, kLimit_s);
}

/// Does the box hang in the gripper after a pick-up under the given pad friction and force?
bool holds(double friction, double grip_force_n) {
  WorldSpec spec = fetch_world();
  spec.friction.pairs[{"box", "pad"}] = friction;
  spec.robot.grip_force_n = grip_force_n;
  OdeSimulator simulator(spec);
  REQUIRE(simulator.reset({{"robot.x", 1.5}, {"box.x", 1.5}}, 1).status == SimStatus::kOk);
  const Outcome outcome = pick(simulator);
  const bool held = flag(simulator.observe(), "box.held");
  CHECK(outcome.status == (held ? SimStatus::kOk : SimStatus::kFailed));
  return held;
}

TEST_CASE("fetching brings the box and the robot to the target from any start") {
  OdeSimulator simulator(fetch_world());
  const std::array<std::pair<double, double>, 5> starts = {
      {{0.05, 1.05}, {0.5, 1.5}, {0.95, 1.95}, {0.2, 1.7}, {0.7, 1.2}}};
  for (const auto& start : starts) {
    const double robot_x_m = start.first, box_x_m = start.second;
    CAPTURE(robot_x_m);
    CAPTURE(box_x_m);
    REQUIRE(simulator.reset({{"robot.x", robot_x_m}, {"box.x", box_x_m}}, 7).status ==
            SimStatus::kOk);
    State state = simulator.observe();
    CHECK(number(state, "robot.x") == doctest::Approx(robot_x_m).epsilon(1e-12));
    CHECK(number(state, "box.x") == box_x_m);
    CHECK_FALSE(flag(state, "box.held"));

    REQUIRE(go(simulator, 1.5).status == SimStatus::kOk);
    CHECK(number(simulator.observe(), "robot.x") == doctest::Approx(1.5).epsilon(0.005));
    REQUIRE(pick(simulator).status == SimStatus::kOk);
    state = simulator.observe();
    CHECK(flag(state, "box.held"));
    CHECK(number(state, "box.z") > 0.2);
    REQUIRE(go(simulator, 0.5).status == SimStatus::kOk);
    CHECK(flag(simulator.observe(), "box.held"));
    REQUIRE(place(simulator, 0.5).status == SimStatus::kOk);

    state = simulator.observe();
    CHECK(std::abs(number(state, "robot.x") - 0.5) < 0.006);
    CHECK(std::abs(number(state, "box.x") - 0.5) < 0.025);
    CHECK(number(state, "box.z") == doctest::Approx(0.035).epsilon(0.02));
    CHECK(std::abs(number(state, "box.pitch")) < 0.01);
    CHECK_FALSE(flag(state, "box.held"));
  }
}

TEST_CASE("the box is carried without slipping, turning or shaking") {
  OdeSimulator simulator(fetch_world());
  REQUIRE(simulator.reset({{"robot.x", 1.5}, {"box.x", 1.7}}, 1).status == SimStatus::kOk);
  REQUIRE(pick(simulator).status == SimStatus::kOk);
  struct Watch {
    double least_offset_m = 1.0, most_offset_m = -1.0, least_z_m = 1.0, most_z_m = 0.0;
    bool always_held = true;
  } seen;
  simulator.watch(
      [](void* context, double, const OdeSimulator& at) {
        Watch& w = *static_cast<Watch*>(context);
        const State state = at.state();
        const double offset_m = number(state, "box.x") - number(state, "tool.x");
        w.least_offset_m = std::min(w.least_offset_m, offset_m);
        w.most_offset_m = std::max(w.most_offset_m, offset_m);
        w.least_z_m = std::min(w.least_z_m, number(state, "box.z"));
        w.most_z_m = std::max(w.most_z_m, number(state, "box.z"));
        w.always_held = w.always_held && flag(state, "box.held");
      },
      &seen);
  REQUIRE(go(simulator, 0.5).status == SimStatus::kOk);
  CHECK(seen.always_held);
  CHECK(seen.most_offset_m - seen.least_offset_m < 1e-4);
  CHECK(seen.most_z_m - seen.least_z_m < 1e-3);
}

TEST_CASE("friction holds the box exactly where Coulomb's law says so") {
  // Two pads of friction mu pressed with F carry m g if 2 mu F > m g.
  const double weight_n = 0.3 * 9.81;
  for (const double grip_force_n : {10.0, 20.0}) {
    CAPTURE(grip_force_n);
    const double threshold = weight_n / (2.0 * grip_force_n);
    CHECK_FALSE(holds(0.9 * threshold, grip_force_n));
    CHECK(holds(1.15 * threshold, grip_force_n));  // the lift accelerates, so it takes a bit more
  }
}

TEST_CASE("without pad friction the box stays behind and placing fails") {
  WorldSpec spec = fetch_world();
  spec.friction.pairs[{"box", "pad"}] = 0.0;
  OdeSimulator simulator(spec);
  REQUIRE(simulator.reset({{"robot.x", 0.5}, {"box.x", 1.6}}, 1).status == SimStatus::kOk);
  REQUIRE(go(simulator, 1.5).status == SimStatus::kOk);
  CHECK(pick(simulator).status == SimStatus::kFailed);
  REQUIRE(go(simulator, 0.5).status == SimStatus::kOk);
  const State before = simulator.observe();
  const Outcome placed = place(simulator, 0.3);
  CHECK(placed.status == SimStatus::kFailed);
  CHECK(placed.reason == "nothing is held");
  const State after = simulator.observe();
  CHECK(number(after, "box.x") == doctest::Approx(1.6).epsilon(0.001));
  CHECK(number(after, "tool.x") == doctest::Approx(number(before, "tool.x")).epsilon(1e-6));
}

TEST_CASE("the grasp offset lies on the side of the box from which the tool came") {
  OdeSimulator simulator(fetch_world());
  const auto offset_m = [&](double box_x_m) {
    REQUIRE(simulator.reset({{"robot.x", 1.5}, {"box.x", box_x_m}}, 1).status == SimStatus::kOk);
    REQUIRE(pick(simulator).status == SimStatus::kOk);
    const State state = simulator.observe();
    return number(state, "box.x") - number(state, "tool.x");
  };
  for (const double distance_m : {0.05, 0.15, 0.3, 0.45}) {
    CAPTURE(distance_m);
    const double right_m = offset_m(1.5 + distance_m), left_m = offset_m(1.5 - distance_m);
    CHECK(right_m > 0.005);
    CHECK(right_m < 0.012);
    CHECK(left_m < -0.005);
    CHECK(left_m > -0.012);
  }
  // Within the tolerance the tool does not move at all.
  CHECK(offset_m(1.507) == doctest::Approx(0.007).epsilon(0.05));
}

TEST_CASE("a box beyond the end of the arm is out of reach and nothing moves") {
  OdeSimulator simulator(fetch_world());
  REQUIRE(simulator.reset({{"robot.x", 0.5}, {"box.x", 1.6}}, 1).status == SimStatus::kOk);
  const Outcome outcome = pick(simulator);
  CHECK(outcome.status == SimStatus::kFailed);
  CHECK(outcome.reason.find("out of reach") == 0);
  CHECK(outcome.sim_time_s == 0.0);
  CHECK(std::get<double>(outcome.margins.at("reach")) == doctest::Approx(-0.5));
  CHECK(number(simulator.observe(), "tool.x") == 0.5);
}

TEST_CASE("an obstacle on the drive blocks the robot, which says where") {
  WorldSpec spec = fetch_world();
  BodySpec wall;
  wall.name = "wall";
  wall.material = "steel";
  wall.shapes = {BodyShape{{0.1, 0.4, 0.5}, {0.0, 0.0, 0.0}}};
  wall.p_WB = {1.3, -0.6, 0.25};
  spec.bodies.push_back(wall);
  OdeSimulator simulator(spec);
  REQUIRE(simulator.reset({{"robot.x", 0.5}}, 1).status == SimStatus::kOk);
  const Outcome outcome = go(simulator, 1.5);
  CHECK(outcome.status == SimStatus::kFailed);
  CHECK(outcome.reason.find("blocked at 1.00") == 0);
  CHECK(number(simulator.observe(), "robot.x") == doctest::Approx(1.0).epsilon(0.003));
  CHECK(go(simulator, 0.5).status == SimStatus::kOk);
  CHECK(go(simulator, 9.0).reason.find("beyond the end of the drive") != std::string::npos);
}

TEST_CASE("an overlapping start is invalid and names the pair and the depth") {
  WorldSpec spec = fetch_world();
  BodySpec crate;
  crate.name = "crate";
  crate.material = "box";
  crate.shapes = {BodyShape{{0.2, 0.2, 0.2}, {0.0, 0.0, 0.0}}};
  crate.p_WB = {2.0, 0.0, 0.1};
  spec.bodies.push_back(crate);
  OdeSimulator simulator(spec);
  // The faces would meet at box.x = 1.865.
  const Outcome bad = simulator.reset({{"box.x", 1.875}}, 1);
  CHECK(bad.status == SimStatus::kInvalidStart);
  CHECK(bad.reason == "`box` overlaps `crate` by 10.0 mm");
  CHECK(simulator.reset({{"box.x", 1.866}}, 1).status == SimStatus::kOk);
  CHECK(simulator.reset({{"box.x", 1.8665}}, 1).status == SimStatus::kOk);  // 1.5 mm are tolerated
  CHECK(simulator.reset({{"robot.x", 17.0}}, 1).status == SimStatus::kInvalidStart);
}

TEST_CASE("reset refuses what it cannot set") {
  OdeSimulator simulator(fetch_world());
  CHECK(simulator.reset({{"bx.x", 1.0}}, 1).status == SimStatus::kUnsupported);
  CHECK(simulator.reset({{"box.z", 1.0}}, 1).status == SimStatus::kUnsupported);
  CHECK(simulator.reset({{"palm.x", 1.0}}, 1).status == SimStatus::kUnsupported);
  CHECK(simulator.reset({{"box.x", true}}, 1).status == SimStatus::kUnsupported);
  CHECK(simulator.reset({{"box.x", std::nan("")}}, 1).status == SimStatus::kUnsupported);
  CHECK(simulator.reset({{"box.x", std::int64_t{1}}}, 1).status == SimStatus::kOk);
  CHECK(number(simulator.observe(), "box.x") == 1.0);
}

TEST_CASE("an action with a wrong name or argument is unsupported and changes nothing") {
  OdeSimulator simulator(fetch_world());
  REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
  const std::string before = text(simulator.observe(), "digest");
  CHECK(simulator.act("flying", {}, 1.0).status == SimStatus::kUnsupported);
  CHECK(simulator.act("going", {}, 1.0).reason == "`going` needs the argument `target.x`");
  CHECK(simulator.act("going", {{"target.x", 1.0}, {"max_sped", 1.0}}, 1.0).reason ==
        "`going` takes no argument `max_sped`");
  CHECK(simulator.act("going", {{"target.x", std::string("far")}}, 1.0).status ==
        SimStatus::kUnsupported);
  CHECK(simulator.act("going", {{"target.x", 1.0}, {"max_speed_m_s", 0.0}}, 1.0).status ==
        SimStatus::kUnsupported);
  CHECK(simulator.act("picking-up", {{"object", std::string("palm")}}, 1.0).status ==
        SimStatus::kUnsupported);
  CHECK(text(simulator.observe(), "digest") == before);
}

TEST_CASE("an action that outlasts its limit is truncated, and the next one goes on from there") {
  OdeSimulator simulator(fetch_world());
  REQUIRE(simulator.reset({{"robot.x", 0.5}}, 1).status == SimStatus::kOk);
  const Outcome cut = simulator.act("going", {{"target.x", 1.5}}, 1.0);
  CHECK(cut.status == SimStatus::kTruncated);
  CHECK(cut.sim_time_s == doctest::Approx(1.0));
  CHECK(number(simulator.observe(), "robot.x") < 1.0);
  CHECK(go(simulator, 1.5).status == SimStatus::kOk);
  CHECK(simulator.act("going", {{"target.x", 0.5}}, 0.0).status == SimStatus::kTruncated);
}

TEST_CASE("a world that explodes is a loss, until the next reset") {
  WorldSpec spec = fetch_world();
  // A box deep in a huge block, and a solver that undoes that within one short step.
  spec.bodies.push_back(spec.bodies.front());
  spec.bodies.back().name = "block";
  spec.bodies.back().shapes = {{{100.0, 100.0, 100.0}, {0.0, 0.0, 0.0}, 0.0}};
  spec.bodies.back().mass_kg = 0.0;
  spec.bodies.back().settable.clear();
  spec.bodies.back().p_WB = {1.6, 0.0, 0.0};
  spec.solver.timestep_s = 1e-5;
  spec.solver.start_penetration_m = 1000.0;
  spec.solver.max_correcting_velocity_m_s = 1e12;
  spec.solver.erp = 1.0;
  OdeSimulator simulator(spec);
  REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
  CHECK(go(simulator, 1.5).status == SimStatus::kLost);
  CHECK(go(simulator, 1.5).status == SimStatus::kLost);
  CHECK(simulator.reset({}, 1).status == SimStatus::kOk);
}

TEST_CASE("a robot that holds something refuses to pick it up again") {
  OdeSimulator simulator(fetch_world());
  REQUIRE(simulator.reset({{"robot.x", 1.5}, {"box.x", 1.5}}, 1).status == SimStatus::kOk);
  REQUIRE(pick(simulator).status == SimStatus::kOk);
  CHECK(pick(simulator).status == SimStatus::kFailed);
  CHECK(flag(simulator.observe(), "box.held"));
}

TEST_CASE("a box too heavy for the friction of the pads stays on the floor") {
  WorldSpec spec = fetch_world();
  for (BodySpec& body : spec.bodies) {
    if (body.name == "box") body.mass_kg = 3.0;  // 29 N against 24 N of friction
  }
  OdeSimulator simulator(spec);
  REQUIRE(simulator.reset({{"robot.x", 1.5}, {"box.x", 1.6}}, 1).status == SimStatus::kOk);
  CHECK(pick(simulator).status == SimStatus::kFailed);
  CHECK(number(simulator.observe(), "box.z") < 0.05);
}

TEST_CASE("a box turned a little is grasped and straightened by the pads") {
  OdeSimulator simulator(fetch_world());
  REQUIRE(simulator.reset({{"robot.x", 1.5}, {"box.x", 1.6}, {"box.yaw", 0.1}}, 1).status ==
          SimStatus::kOk);
  CHECK(number(simulator.observe(), "box.yaw") == doctest::Approx(0.1));
  CHECK(pick(simulator).status == SimStatus::kOk);
  CHECK(std::abs(number(simulator.observe(), "box.yaw")) < 0.02);
}

TEST_CASE("a simulator lists exactly the variables that it observes") {
  OdeSimulator simulator(fetch_world());
  REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
  State state = simulator.observe();
  CHECK(state.erase("digest") == 1);
  const SimulatorInfo info = simulator.info();
  REQUIRE(info.parameters.size() == state.size());
  std::size_t index = 0;
  for (const auto& [name, value] : state) CHECK(info.parameters[index++].name == name);
  CHECK(info.actions == std::vector<std::string>{"going", "picking-up", "placing"});
}

}  // namespace
}  // namespace parallax::harness
