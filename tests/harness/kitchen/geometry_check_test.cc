#include <doctest/doctest.h>

#include <algorithm>

#include "harness/engine/world_check.h"
#include "tests/harness/kitchen/kitchen_world.h"

namespace parallax::harness {
namespace {

/// The message about `path`, or empty.
std::string problem_at(const WorldSpec& spec, std::string_view path) {
  for (const WorldProblem& problem : check_world(spec)) {
    if (problem.path == path) return problem.message;
  }
  return {};
}

TEST_CASE("the kitchen as it is has no problem") { CHECK(check_world(kitchen_world()).empty()); }

TEST_CASE("a drawer longer than its bay is reported with what it meets") {
  WorldSpec spec = kitchen_world();
  for (BodySpec& body : spec.bodies) {
    if (body.name != "cabinet") continue;
    body.shapes.push_back({{0.02, 0.6, 0.5}, {1.75, 0.9, 0.58}, 0.0});  // a wall inside the bay
  }
  const std::string message = problem_at(spec, "joints/dMid/range_m");
  CHECK(message == "`drawer_mid` meets `cabinet` 0.000 m from its lower stop");
}

TEST_CASE("a handle that no arm reaches from anywhere is reported") {
  WorldSpec spec = kitchen_world();
  joint_of(spec, "dTop").handle->p_CH.z() = 2.0;
  body_of(spec, "drawer_top").shapes.back().p_BS.z() = 2.0;  // the bar itself
  CHECK(problem_at(spec, "joints/dTop/handle").find("the reach is 0.950 m") != std::string::npos);
}

TEST_CASE("a handle or a grasp where the body is not is reported") {
  WorldSpec spec = kitchen_world();
  joint_of(spec, "dLow").handle->p_CH.x() += 0.5;
  CHECK(problem_at(spec, "joints/dLow/handle") ==
        "there is nothing of `drawer_low` within 0.008 m of `at_m`");
  spec = kitchen_world();
  body_of(spec, "milk1").grasp->p_BG.z() = 0.2;
  CHECK(problem_at(spec, "bodies/milk1/grasp") ==
        "there is nothing of `milk1` within 0.035 m of `at_m`");
}

TEST_CASE("a place inside furniture is reported") {
  WorldSpec spec = kitchen_world();
  for (PlaceSpec& place : spec.places) {
    if (place.name == "pt2") place.p_FP.z() = 0.5;
  }
  CHECK(problem_at(spec, "places/pt2") == "lies inside `table`");
}

TEST_CASE("a point with nothing below it is found") {
  const std::vector<NamedPoint> points = {
      {"on", {1.46, 0.2, 0.85}}, {"off", {0.3, 0.2, 0.85}}, {"in a drawer", {1.5, 0.9, 0.53}}};
  CHECK(unsupported_points(kitchen_world(), points) == std::vector<std::string>{"off"});
}

TEST_CASE("what a mobile robot lacks is reported at its key") {
  WorldSpec spec = kitchen_world();
  spec.mobile->arms.front().joint = "left_armm";
  CHECK(problem_at(spec, "robot/arms/left/joint") == "no joint `left_armm`");
  spec = kitchen_world();
  spec.mobile->arms.front().carry_B.x() = 3.0;
  CHECK(problem_at(spec, "robot/arms/left/carry_m") == "is out of the arm's reach");
  spec = kitchen_world();
  spec.places.front().frame = "drawer_mdi";
  const auto problems = check_world(spec);
  REQUIRE(problems.size() == 1);
  CHECK(problems.front().suggestion == "drawer_mid");
}

}  // namespace
}  // namespace parallax::harness
