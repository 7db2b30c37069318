#include "harness/engine/world_check.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "harness/robot/servo.h"
#include "harness/world/arguments.h"
#include "harness/world/world_layout.h"
#include "tests/harness/world/fetch_world.h"

namespace parallax::harness {
namespace {

BodySpec& body(WorldSpec& spec, std::string_view name) {
  return *std::find_if(spec.bodies.begin(), spec.bodies.end(),
                       [&](const BodySpec& one) { return one.name == name; });
}
JointSpec& joint(WorldSpec& spec, std::string_view name) {
  return *std::find_if(spec.joints.begin(), spec.joints.end(),
                       [&](const JointSpec& one) { return one.name == name; });
}

/// The paths of all problems, in a row.
std::string paths(const WorldSpec& spec) {
  std::string all;
  for (const WorldProblem& problem : check_world(spec)) {
    all += (all.empty() ? "" : " ") + problem.path;
  }
  return all;
}

TEST_CASE("a sound world has no problems, with a robot or without") {
  CHECK(paths(fetch_world()).empty());
  WorldSpec empty;
  CHECK(paths(empty).empty());
  CHECK(observables(empty).empty());
}

TEST_CASE("every problem of a world is found and located") {
  WorldSpec spec = fetch_world();
  SUBCASE("a misspelt body") {
    joint(spec, "lift").child = "plam";
    const auto problems = check_world(spec);
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].path == "joints/lift/child");
    CHECK(problems[0].message == "no body `plam`");
    CHECK(problems[0].suggestion == "palm");
  }
  SUBCASE("a misspelt role") {
    spec.robot.lift_joint = "lfit";
    const auto problems = check_world(spec);
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].path == "robot/lift_joint");
    CHECK(problems[0].suggestion == "lift");
  }
  SUBCASE("several at once") {
    spec.solver.timestep_s = 0.0;
    body(spec, "box").mass_kg = -1.0;
    body(spec, "box").shapes.clear();
    spec.friction.fallback = std::nan("");
    CHECK(paths(spec) ==
          "solver/timestep_s friction/fallback bodies/box/mass_kg bodies/box/shapes");
  }
  SUBCASE("names") {
    body(spec, "box").name = "palm";
    CHECK(paths(spec).find("bodies/palm") != std::string::npos);
    body(spec, "far_pad").name = "floor";
    CHECK(paths(spec).find("bodies/floor") != std::string::npos);
  }
  SUBCASE("a joint that moves what has no mass") {
    body(spec, "arm").mass_kg = 0.0;
    CHECK(paths(spec) == "bodies/arm/mass_kg");
  }
  SUBCASE("a body that hangs on two joints") {
    joint(spec, "finger").child = "palm";
    CHECK(paths(spec) == "joints/finger/child joints/finger/child");
  }
  SUBCASE("a setting that the body does not take") {
    body(spec, "base").settable = {"y"};
    body(spec, "box").settable = {"x", "roll"};
    body(spec, "arm").settable = {"x"};
    CHECK(paths(spec) == "bodies/base/settable bodies/arm/settable bodies/box/settable");
  }
  SUBCASE("stops that exclude the default placement") {
    joint(spec, "reach").low_m = 0.1;
    CHECK(paths(spec) == "joints/reach/range_m");
  }
  SUBCASE("stops that are reversed, or one") {
    joint(spec, "reach").low_m = 0.1;
    joint(spec, "reach").high_m = 0.0;
    joint(spec, "lift").low_m = 0.0;
    joint(spec, "lift").high_m = 0.0;
    CHECK(paths(spec) == "joints/reach/range_m joints/lift/range_m");
  }
  SUBCASE("settings of the engine that are no physics") {
    spec.solver.contact_erp = 7.0;
    spec.solver.contact_cfm = 2.0;
    spec.solver.gravity_m_s2 = 9.81;
    CHECK(paths(spec) == "solver/contact_erp solver/contact_cfm solver/gravity_m_s2");
    spec = fetch_world();
    spec.solver.gravity_m_s2 = -1e12;
    CHECK(paths(spec) == "solver/gravity_m_s2");
  }
  SUBCASE("what is too heavy, too large or too far") {
    body(spec, "box").mass_kg = 1e30;
    body(spec, "box").shapes.front().size_m.x() = 1e9;
    body(spec, "box").p_WB.x() = 1e30;
    CHECK(paths(spec) == "bodies/box/mass_kg bodies/box/position_m bodies/box/shapes");
  }
  SUBCASE("a role without a motor, or along the wrong axis") {
    joint(spec, "reach").max_force_n = 0.0;
    joint(spec, "lift").axis_W = {0.0, 0.0, -1.0};
    CHECK(paths(spec) == "robot/reach_joint robot/lift_joint");
  }
  SUBCASE("a tool that is not on the robot") {
    joint(spec, "reach").parent = "";
    CHECK(paths(spec) == "robot/base_body robot/base_body");
  }
}

TEST_CASE("the layout is sorted, welds parts together and finds what is free") {
  const WorldLayout layout = lay_out(fetch_world());
  REQUIRE(layout.bodies.size() == 6);
  CHECK(layout.bodies[layout.bodies.id_at(0)].name == "arm");
  const BodyId palm = *layout.find_body("palm"), near = *layout.find_body("near_pad"),
               far = *layout.find_body("far_pad"), box = *layout.find_body("box");
  CHECK(layout.link_of[palm.index()] == layout.link_of[near.index()]);
  CHECK(layout.link_of[palm.index()] != layout.link_of[far.index()]);
  CHECK(layout.links.size() == 5);
  CHECK(layout.assembly_of[palm.index()] == layout.assembly_of[far.index()]);
  CHECK(layout.assembly_of[box.index()] != layout.assembly_of[far.index()]);
  CHECK(layout.is_free[box.index()]);
  CHECK_FALSE(layout.is_free[far.index()]);
  CHECK_FALSE(layout.find_body("floor").has_value());
}

TEST_CASE("observables name units and what can be set") {
  for (const Parameter& one : observables(fetch_world())) {
    CAPTURE(one.name);
    const bool settable = one.name == "box.x" || one.name == "box.y" || one.name == "box.yaw" ||
                          one.name == "robot.x";
    CHECK(one.settable == settable);
    CHECK_FALSE(one.unit.empty());
  }
}

TEST_CASE("the controller table is sorted and says what is required") {
  std::string_view last;
  for (const ControllerSpec& spec : controllers()) {
    CHECK(last < spec.name);
    last = spec.name;
    CHECK(find_controller(spec.name) == &spec);
  }
  CHECK(find_controller("flying") == nullptr);
}

TEST_CASE("a servo reaches its target within its tolerance and never jumps") {
  constexpr double kStep_s = 0.002;
  for (const double target_m : {-1.3, -0.02, 0.004, 0.3, 2.0}) {
    for (const double tolerance_m : {0.001, 0.012}) {
      CAPTURE(target_m);
      CAPTURE(tolerance_m);
      const Motion motion{0.4, 0.8, tolerance_m, 6.0};
      AxisServo servo;
      servo.reset(0.0);
      servo.move_to(target_m, motion);
      double position_m = 0.0, velocity = 0.0, time_s = 0.0, fastest = 0.0;
      do {
        const double next = servo.next_velocity(position_m, velocity, kStep_s);
        REQUIRE(std::abs(next - velocity) <= motion.acceleration_m_s2 * kStep_s + 1e-12);
        velocity = next;
        fastest = std::max(fastest, std::abs(velocity));
        position_m += kStep_s * velocity;
        time_s += kStep_s;
        REQUIRE(time_s < 20.0);
      } while (!servo.at_rest());
      CHECK(fastest <= motion.max_speed_m_s);
      CHECK(std::abs(target_m - position_m) <= tolerance_m);
      // It stops on the side it came from.
      CHECK((target_m - position_m) * target_m >= 0.0);
      CHECK(time_s <= 2.0 * nominal_time_s(target_m, motion) + 0.3);
    }
  }
}

}  // namespace
}  // namespace parallax::harness
