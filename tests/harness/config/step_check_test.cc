// Steps longer than a shape is thick are warned of before the run.

#include <Eigen/Geometry>

#include "harness/world/step_length.h"
#include "tests/harness/config/imported_world.h"

namespace parallax::harness::test {
namespace {

const std::string kSteps = "solver: {timestep_s: 0.004}\n";

/// A world in which the pads, which are 4 mm thick along x, may meet a plate at this place.
std::string world_with_plate(double plate_x_m, double plate_m = 0.004) {
  std::string world = kWorld;
  for (const char* pad : {"near: ", "far: "}) {
    world = replaced(world, pad + std::string("{size_m: [0.02,"),
                     pad + std::string("{size_m: [0.004,"));
  }
  const std::string plate = "  plate: {size_m: [" + std::to_string(plate_m) +
                            ", 0.4, 0.05], position_m: [" + std::to_string(plate_x_m) +
                            ", 0, 0.24]}\njoints:";
  return kSteps + replaced(world, "joints:", plate);
}

std::string scenario_at(const std::string& speeds) {
  return replaced(kScenario, "object: box}", "object: box, " + speeds + "}");
}

/// Where the pads get to when the reach drives them against the plate at 0.8 m, from 0.5 m on.
double pads_after(const WorldSpec& spec, double speed_m_s) {
  OdeWorld world(spec);
  REQUIRE_FALSE(world.reset(default_placements(world.layout()), 1).has_value());
  const SliderId reach = *world.layout().find_slider("reach");
  for (int i = 0; i < 200 && world.slider_position_m(reach) < 0.5; ++i) {
    world.set_motor(reach, speed_m_s, 4000.0);
    REQUIRE(world.step());
  }
  return world.position(*world.layout().find_body("near")).x();
}

TEST_CASE("a fast hand goes through a thin plate, which is told; a slow one does not, and is not") {
  std::size_t through = 0;
  for (int i = 0; i < 5; ++i) {
    Workspace workspace;
    workspace.write("world.yaml", world_with_plate(0.8 + 0.007 * i));
    const auto scenario = workspace.load(scenario_at("max_speed_m_s: 10"));
    for (const auto& one : workspace.reports()) CAPTURE(one);
    REQUIRE(scenario.has_value());
    CHECK(
        workspace.reports() ==
        std::vector<std::string>{
            "W5138 at 16:66: actions/PickUp/max_speed_m_s: 10 m/s are 40 mm in a step of 4 ms, but "
            "`far` has a shape of 4 mm: one may pass through the other unnoticed"});
    if (pads_after(scenario->world, 10.0) > 0.9) ++through;

    REQUIRE(workspace.load(scenario_at("max_speed_m_s: 0.99")).has_value());
    CHECK(workspace.reports().empty());
    CHECK(pads_after(scenario->world, 0.5) < 0.8 + 0.007 * i);
  }
  CHECK(through > 0);
}

TEST_CASE("what counts is the thinnest shape that moves or may be met, and the step") {
  const auto said = [](const std::string& world, const std::string& scenario) {
    Workspace workspace;
    workspace.write("world.yaml", world);
    REQUIRE(workspace.load(scenario).has_value());
    return workspace.reports();
  };
  // The base drives at 0.6 m/s, the hand moves at 0.25 m/s: 2.4 mm and 1 mm a step.
  CHECK(said(world_with_plate(0.8, 0.0025), kScenario).empty());
  CHECK(said(world_with_plate(0.8, 0.0023), kScenario).size() == 1);
  CHECK(said(world_with_plate(0.8, 0.0009), kScenario).size() == 3);
  CHECK(said(replaced(world_with_plate(0.8, 0.0009), "timestep_s: 0.004", "timestep_s: 0.001"),
             kScenario)
            .empty());
  // Bodies without collisions are not met.
  CHECK(said(replaced(world_with_plate(0.8, 0.0009), "position_m: [0.8",
                      "collides: false, position_m: [0.8"),
             kScenario)
            .empty());
}

TEST_CASE("a fall is told where something thin is below, and no shape of it stops it") {
  const auto said = [](const std::string& height) {
    Workspace workspace;
    workspace.write(
        "world.yaml",
        kSteps + replaced(replaced(kWorld, "[1.5, 0, 0.035]", "[1.5, 0, " + height + "]"),
                          "joints:",
                          "  shelf: {size_m: [0.4, 0.4, 0.01], position_m: [1.5, 0, "
                          "0.095]}\njoints:"));
    REQUIRE(workspace.load(kScenario).has_value());
    return workspace.reports();
  };
  // 10 mm in 4 ms are 2.5 m/s, which a fall of 0.319 m comes to.
  CHECK(said("0.135").empty());
  CHECK(said("0.45").empty());
  const auto fast = said("0.46");
  REQUIRE(fast.size() == 1);
  CHECK(fast[0].starts_with("W5138 at 9:"));
  CHECK(fast[0].find("bodies/box falls: 2.53 m/s are 10.1 mm in a step of 4 ms, but `shelf`") !=
        fast[0].npos);
}

TEST_CASE("a hull is as thick as it is between a face and what lies behind") {
  // A plate of 10 mm that leans by 45 degrees: the box round it says nothing of it.
  std::vector<Eigen::Vector3d> corners;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.25 * 3.14159265358979, Eigen::Vector3d::UnitX()).toRotationMatrix();
  for (const double x : {-0.1, 0.1}) {
    for (const double y : {-0.1, 0.1}) {
      for (const double z : {-0.005, 0.005}) corners.push_back(turn * Eigen::Vector3d(x, y, z));
    }
  }
  const std::vector<std::array<std::uint32_t, 3>> faces = {
      {0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
      {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  Eigen::Vector3d middle;
  std::string why;
  const auto hull = hull_with(corners, faces, middle, why);
  REQUIRE_MESSAGE(hull.has_value(), why);
  BodyShape shape{hull->size_m};
  shape.form = ShapeForm::kHull;
  shape.hull = std::make_shared<const ConvexHull>(*hull);
  CHECK(shape.size_m.minCoeff() > 0.14);
  CHECK(thickness_m(shape) == doctest::Approx(0.01));
}

}  // namespace
}  // namespace parallax::harness::test
