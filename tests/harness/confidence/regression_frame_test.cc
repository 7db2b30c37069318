#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "harness/confidence/regression.h"

namespace parallax::harness {
namespace {

Region region(std::string name, Interval x, Interval yaw) {
  Region result;
  result.name = std::move(name);
  result.on(RegionAxis::kX) = x;
  result.on(RegionAxis::kYaw) = yaw;
  return result;
}

StateMapping mapping() {
  base::DiagnosticSink sink;
  auto regions =
      RegionSet::make({region("r1", {0, 1}, {2, 4}), region("r2", {1, 2}, {2, 4})}, false, sink);
  REQUIRE(regions.has_value());
  return StateMapping(*regions, {{"RobotIn", 1, InsideBinding{"robot", 0, {}, {}}, {}},
                                 {"BoxIn", 1, InsideBinding{"box", 0, "box.held", {}}, {}},
                                 {"Holding", 0, FlagBinding{"box.held"}, {}},
                                 {"Mood", 0, IgnoredBinding{}, {}}});
}

std::vector<GroundFluent> fluents() {
  std::vector<GroundFluent> result;
  for (const auto* text :
       {"BoxIn(r1)", "BoxIn(r2)", "Holding", "Mood", "RobotIn(r1)", "RobotIn(r2)"}) {
    result.push_back(ground_fluent(text));
  }
  return result;
}

const StartCuboid kStart = {{{"box.x", {1, 2}}, {"box.yaw", {2, 4}}, {"robot.x", {0, 1}}}};

TEST_CASE("frame: pinned variables are tested, flags and absences are named as not covered") {
  const auto placed = regression_frame(mapping(), kStart, fluents(), {"BoxIn(r1)", "RobotIn(r2)"});
  CHECK(placed.x_names == std::vector<std::string>{"box.x", "box.yaw", "robot.x"});
  CHECK(placed.y_names == std::vector<std::string>{"box.x", "box.yaw", "robot.x", "robot.yaw"});
  CHECK(placed.y_cell[2]->lower == 1.0);
  CHECK(placed.not_covered == std::vector<std::string>{"Holding"});

  const auto held = regression_frame(mapping(), kStart, fluents(), {"Holding", "RobotIn(r1)"});
  CHECK(held.y_names == std::vector<std::string>{"robot.x", "robot.yaw"});
  CHECK(held.not_covered == std::vector<std::string>{"BoxIn(r1)", "BoxIn(r2)", "Holding"});
}

TEST_CASE(
    "rows: values by name, angles within half a turn of their cell, NaN for what is missing") {
  Tally tally(regression_frame(mapping(), kStart, fluents(), {"BoxIn(r1)"}));
  const State start{
      {"box.x", 1.5}, {"box.yaw", 3.0}, {"robot.x", std::int64_t{1}}, {"extra", true}};
  const State last{{"box.x", 0.25}, {"box.yaw", 3.5 - 2 * std::numbers::pi}};
  add_clean_run(tally, start, last);
  CHECK(tally.x() == std::vector<std::vector<double>>{{1.5, 3.0, 1.0}});
  REQUIRE(tally.y()[0].size() == 2);
  CHECK(tally.y()[0][0] == 0.25);
  CHECK(tally.y()[0][1] == doctest::Approx(3.5).epsilon(1e-12));
  add_clean_run(tally, start, {{"box.x", 0.25}});
  CHECK(std::isnan(tally.y()[1][1]));
  CHECK(tally.clean() == 2);
}

}  // namespace
}  // namespace parallax::harness
