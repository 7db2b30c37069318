// Errors about doors that no hand can open, at their place in the file.

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/harness/doors/door_world.h"

namespace parallax::harness::test {
namespace {

const std::string kHandle =
    "handle: {at_m: [-0.07, 0.36, 0], approach: [0, -1, 0], wrist_rad: 1.570796, width_m: 0.02}";

std::vector<std::string> reports_of(const std::string& world,
                                    const std::string& actions = " {}\n") {
  DoorWorkspace workspace;
  const auto scenario = workspace.load(door_scenario(world, actions));
  return workspace.reports();
}

/// The only report. There must be exactly one.
std::string only_report(const std::string& world, const std::string& actions = " {}\n") {
  const auto reports = reports_of(world, actions);
  for (const std::string& report : reports) CAPTURE(report);
  REQUIRE(reports.size() == 1);
  return reports.front();
}

TEST_CASE("the door of the tests is sound") { CHECK(reports_of(kDoorWorld).empty()); }

TEST_CASE("a handle needs a hinge with stops, upright, and a lever") {
  CHECK(only_report(replaced(kDoorWorld, "      range_rad: [0, 1.6]\n", "")) ==
        "E5126 at 31:7: joints/hinge/handle: is on a hinge that turns for "
        "ever: a door has stops (`range_rad`)");
  CHECK(only_report(replaced(kDoorWorld, "axis: z", "axis: [0, 0.1, 1]"))
            .find("joints/hinge/handle: is on a hinge that leans: hands turn about the vertical") !=
        std::string::npos);
  CHECK(only_report(replaced(kDoorWorld, kHandle, replaced(kHandle, "-0.07, 0.36", "0, -0.42")))
            .find("joints/hinge/handle: lies within 5 cm of the axis of its hinge") !=
        std::string::npos);
}

TEST_CASE("only sliders and hinges have handles") {
  const std::string fixed =
      "    plate: {type: fixed, parent: stand, child: cover, " + kHandle + "}\n  places:";
  const std::string world =
      replaced(replaced(kDoorWorld, "  places:", fixed), "    stand: {size",
               "    cover: {size_m: [0.1, 0.1, 0.01], mass_kg: 1, position_m: [-1.3, -0.4, 0.8]}\n"
               "    stand: {size");
  CHECK(only_report(world).find("only sliders and hinges have handles") != std::string::npos);
}

TEST_CASE("a handle has to be on its door, within reach and between the pads") {
  CHECK(only_report(replaced(kDoorWorld, kHandle, replaced(kHandle, "-0.07, 0.36", "-0.30, 0.36")))
            .find("there is nothing of `leaf` within 0.010 m of `at_m`") != std::string::npos);
  CHECK(
      only_report(replaced(kDoorWorld, kHandle, replaced(kHandle, "width_m: 0.02", "width_m: 0.2")))
          .find("joints/hinge/handle/width_m: is 0.2 m, but no gripper opens wider than 0.1 m") !=
      std::string::npos);
  std::string high = replaced(kDoorWorld, "at_m: [-0.07, 0.36, 0], approach",
                              "at_m: [-0.07, 0.36, 0.95], approach");
  high = replaced(high, "at_m: [-0.07, 0.36, 0], roll", "at_m: [-0.07, 0.36, 0.95], roll");
  CHECK(only_report(high).find("joints/hinge/handle: is 1.150 m above or below every shoulder") !=
        std::string::npos);
}

TEST_CASE("a door that meets the wall on its way is reported") {
  const std::string world =
      replaced(kDoorWorld, "wall_right: {size_m: [0.1, 3.0, 2.5], position_m: [0, -2, 1.25]}",
               "wall_right: {size_m: [1.2, 3.0, 2.5], position_m: [0, -1.95, 1.25]}");
  CHECK(only_report(world).find(
            "joints/hinge/range_rad: `leaf` meets `wall_right` before its upper stop") !=
        std::string::npos);
}

TEST_CASE("drawers and doors are told apart, with the names that would do") {
  const std::string door = "\n  Open(): {controller: open-door, arm: arm, joint: finger}\n";
  const std::string drawer = "\n  Open(): {controller: open-drawer, arm: arm, joint: hinge}\n";
  const std::string bare = "\n  Open(): {controller: close-door, arm: arm, joint: hinge}\n";
  CHECK(only_report(kDoorWorld, door).find("is `finger`, which does not name a hinge") !=
        std::string::npos);
  CHECK(only_report(kDoorWorld, drawer).find("is `hinge`, which does not name a slider") !=
        std::string::npos);
  CHECK(only_report(replaced(kDoorWorld, "      " + kHandle + "\n", ""), bare)
            .find("is `hinge`, which has no `handle`") != std::string::npos);
  CHECK(reports_of(kDoorWorld, bare).empty());
  CHECK(only_report(kDoorWorld,
                    replaced(bare, "joint: hinge", "joint: hinge, stop_tolerance_rad: -1"))
            .find("stop_tolerance_rad") != std::string::npos);
}

TEST_CASE("a tolerance of half the way between the stops, or more, is refused where it is") {
  const auto door = [](const char* tolerance) {
    return std::string("\n  Open(): {controller: open-door, arm: arm, joint: hinge") + tolerance +
           "}\n";
  };
  CHECK(reports_of(kDoorWorld, door(", stop_tolerance_rad: 0.79")).empty());
  for (const char* value : {"0.8", "4"}) {
    const std::string report =
        only_report(kDoorWorld, door((", stop_tolerance_rad: " + std::string(value)).c_str()));
    CHECK(report.starts_with("E5126 at "));
    CHECK(report.find(std::string("actions/Open/stop_tolerance_rad: is ") + value +
                      " rad, half of the 1.6 rad between the stops of `hinge` or more") !=
          std::string::npos);
  }
  // The default of `stop_tolerance_rad` is checked as well.
  CHECK(only_report(replaced(kDoorWorld, "range_rad: [0, 1.6]", "range_rad: [0, 0.09]"), door(""))
            .find("actions/Open/joint: is `hinge`, whose stops are 0.09 rad apart: the 0.05 rad of "
                  "`stop_tolerance_rad` are half of that or more") != std::string::npos);
}

TEST_CASE("the same of a drawer") {
  const std::string drawer =
      R"(    box: {size_m: [0.3, 0.3, 0.1], mass_kg: 2, position_m: [2, 3, 0.7]}
    stand: {size)";
  const std::string slide =
      "    slide: {child: box, axis: x, range_m: [0, 0.3], handle: {at_m: [-0.15, 0, 0], approach: "
      "[1, 0, 0], width_m: 0.02}}\n  places:";
  const std::string world =
      replaced(replaced(kDoorWorld, "    stand: {size", drawer), "  places:", slide);
  for (const char* controller : {"open-drawer", "close-drawer"}) {
    const std::string action = std::string("\n  Move(): {controller: ") + controller +
                               ", arm: arm, joint: slide, stop_tolerance_m: 0.14}\n";
    CHECK(reports_of(world, action).empty());
    CHECK(only_report(world, replaced(action, "0.14", "0.15"))
              .find("actions/Move/stop_tolerance_m: is 0.15 m, half of the 0.3 m between the stops "
                    "of `slide` or more") != std::string::npos);
  }
}

TEST_CASE("a hand that is placed out of its arm's reach is told with what to do") {
  const std::string moved = "    chassis: {position_m: [-3, 1, 0]}\n    stand: {size";
  const std::string report = only_report(replaced(kDoorWorld, "    stand: {size", moved));
  CAPTURE(report);
  CHECK(report.starts_with("E5126 at "));
  CHECK(report.find("robot/arms/arm: the hand is placed 3.") != std::string::npos);
  CHECK(report.find("what moves `chassis` has to move `palm` and its pads along") !=
        std::string::npos);
}

}  // namespace
}  // namespace parallax::harness::test
