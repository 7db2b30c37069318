#include "harness/region/state_mapping.h"

#include <doctest/doctest.h>

#include "compiler/base/codes/scenarios.h"

namespace parallax::harness {
namespace {

Region region_along_x(std::string name, double lower, double upper) {
  Region region;
  region.name = std::move(name);
  region.on(RegionAxis::kX) = Interval{lower, upper};
  return region;
}

/// Robot and box on a line of three regions; a held box is in no region.
StateMapping line() {
  base::DiagnosticSink sink;
  auto regions = RegionSet::make(
      {region_along_x("r1", 0, 1), region_along_x("r2", 1, 2), region_along_x("r3", 2, 3)}, false,
      sink);
  return StateMapping(
      *regions, {{"RobotIn", 1, InsideBinding{"robot", 0, {}, {}}, {base::FileId(0), 1, 2}},
                 {"In", 2, InsideBinding{"{0}", 1, "{0}.held", {}}, {base::FileId(0), 2, 3}},
                 {"HeldIn", 2, InsideBinding{"{0}", 1, {}, "{0}.held"}, {base::FileId(0), 3, 4}},
                 {"Holding", 1, FlagBinding{"{0}.held"}, {base::FileId(0), 4, 5}},
                 {"Thinking", 0, IgnoredBinding{}, {base::FileId(0), 5, 6}}});
}

std::vector<GroundFluent> fluents_of(const std::vector<std::string>& texts) {
  std::vector<GroundFluent> result;
  for (const auto& text : texts) result.push_back(ground_fluent(text));
  return result;
}

std::vector<GroundFluent> all_fluents() {
  return fluents_of({"RobotIn(r1)", "RobotIn(r2)", "RobotIn(r3)", "In(box,r1)", "In(box,r2)",
                     "In(box,r3)", "HeldIn(box,r1)", "Holding(box)", "Thinking"});
}

std::vector<base::Diagnostic> start_errors(
    const std::set<std::string>& true_fluents, const std::vector<SampledDimension>& extra = {},
    const std::vector<GroundFluent>& fluents = all_fluents()) {
  base::DiagnosticSink sink;
  CHECK_FALSE(line().start_cuboid(fluents, true_fluents, extra, {}, sink).has_value());
  for (const auto& diagnostic : sink.sorted()) {
    CHECK(diagnostic.code == codes::kStartNotSampleable);
  }
  return sink.sorted();
}

TEST_CASE("ground fluents: symbol and arguments, nested terms stay whole") {
  CHECK(ground_fluent("Alive").symbol == "Alive");
  CHECK(ground_fluent("Alive").arguments.empty());
  CHECK(ground_fluent("Alive()").arguments.empty());
  const auto fluent = ground_fluent("On(Left(cup1,a),table)");
  CHECK(fluent.symbol == "On");
  CHECK(fluent.text == "On(Left(cup1,a),table)");
  CHECK(fluent.arguments == std::vector<std::string>{"Left(cup1,a)", "table"});
}

TEST_CASE("patterns: arguments are put in, other braces stay") {
  const auto fluent = ground_fluent("In(box,r1)");
  CHECK(with_arguments("{0}.at.{1}.{0}.{2}", fluent) == "box.at.r1.box.{2}");
  CHECK(is_angle("box.yaw"));
  CHECK_FALSE(is_angle("box.yaws"));
}

TEST_CASE("mapping: a fluent holds where its body is, as flags and borders have it") {
  const auto mapping = line();
  State state{{"robot.x", 0.5}, {"box.x", 1.0}, {"box.held", false}};
  CHECK(mapping.holds(ground_fluent("RobotIn(r1)"), state) == true);
  CHECK(mapping.holds(ground_fluent("RobotIn(r2)"), state) == false);
  CHECK(mapping.holds(ground_fluent("In(box,r1)"), state) == false);
  CHECK(mapping.holds(ground_fluent("In(box,r2)"), state) == true);
  CHECK(mapping.holds(ground_fluent("HeldIn(box,r2)"), state) == false);
  CHECK(mapping.holds(ground_fluent("Holding(box)"), state) == false);
  CHECK_FALSE(mapping.holds(ground_fluent("Thinking"), state).has_value());
  state["box.held"] = true;
  CHECK(mapping.holds(ground_fluent("In(box,r2)"), state) == false);
  CHECK(mapping.holds(ground_fluent("HeldIn(box,r2)"), state) == true);
  CHECK(mapping.holds(ground_fluent("Holding(box)"), state) == true);
  state["robot.x"] = std::int64_t{3};
  CHECK(mapping.holds(ground_fluent("RobotIn(r3)"), state) == true);
}

TEST_CASE("mapping: what the state lacks makes a fluent false and is named, all of it") {
  const auto mapping = line();
  std::set<std::string> missing;
  CHECK(mapping.holds(ground_fluent("In(box,r2)"), {}, &missing) == false);
  CHECK(missing == std::set<std::string>{"box.held", "box.x"});
  missing.clear();
  CHECK(mapping.holds(ground_fluent("In(box,r2)"), {{"box.x", 1.5}}, &missing) == false);
  CHECK(missing == std::set<std::string>{"box.held"});
  missing.clear();
  CHECK(mapping.holds(ground_fluent("RobotIn(r1)"), {{"robot.x", std::string("left")}}, &missing) ==
        false);
  CHECK(missing == std::set<std::string>{"robot.x"});
  CHECK_THROWS_AS(mapping.holds(ground_fluent("Unknown(r1)"), {}), base::ContractViolation);
}

TEST_CASE("start: the cuboid of the running example, with a sampled dimension beside it") {
  base::DiagnosticSink sink;
  const auto cuboid =
      line().start_cuboid(all_fluents(), {"RobotIn(r1)", "In(box,r2)"},
                          {{"box.y", {-0.1, 0.1}}, {"box.x", {0.5, 1.25}}}, {}, sink);
  REQUIRE(cuboid.has_value());
  REQUIRE(cuboid->dimensions.size() == 3);
  CHECK(cuboid->dimensions[0].variable == "box.x");
  CHECK(cuboid->dimensions[0].interval.lower == 1.0);
  CHECK(cuboid->dimensions[0].interval.upper == 1.25);
  CHECK(cuboid->dimensions[1].variable == "box.y");
  CHECK(cuboid->dimensions[2].variable == "robot.x");
  CHECK(cuboid->dimensions[2].interval.upper == 1.0);
}

TEST_CASE("start: a fixed value inside the region wins, one outside is refused") {
  base::DiagnosticSink sink;
  const std::set<std::string> start{"RobotIn(r1)", "In(box,r2)"};
  const auto cuboid = line().start_cuboid(all_fluents(), start, {{"box.x", {1.5, 1.5}}}, {}, sink);
  REQUIRE(cuboid.has_value());
  CHECK(cuboid->dimensions[0].interval.width() == 0.0);
  // 2 is the border, which belongs to the region above.
  const auto found = start_errors(start, {{"box.x", {2.0, 2.0}}});
  REQUIRE(found.size() == 1);
  CHECK(found[0].message ==
        "cannot draw a start state: `box.x` is sampled from 2, outside region `r2` (1 to 2)");
}

TEST_CASE("start: what no reset can make is refused, each fluent once, with its mapping") {
  const auto found =
      start_errors({"RobotIn(r1)", "Holding(box)", "HeldIn(box,r1)"}, {{"box.x", {5, 6}}});
  REQUIRE(found.size() >= 2);
  CHECK(
      found[0].message ==
      "cannot draw a start state: `HeldIn(box,r1)` holds, but a reset cannot make `box.held` true");
  REQUIRE(found[0].notes.size() == 1);
  CHECK(found[0].notes[0].range->begin == 3);
}

TEST_CASE("start: a flag that is drawn is set to what its fluents ask for") {
  const StateMapping lamps(RegionMap(RegionSet()),
                           {{"Dark", 0, FlagBinding{"lit(a)", false, true}, {}},
                            {"Lit", 1, FlagBinding{"lit({0})", false, true}, {}}});
  const std::vector<GroundFluent> fluents = {ground_fluent("Lit(a)"), ground_fluent("Lit(b)")};
  base::DiagnosticSink sink;
  const auto cuboid = lamps.start_cuboid(fluents, {"Lit(b)"}, {}, {}, sink);
  REQUIRE(cuboid.has_value());
  REQUIRE(cuboid->dimensions.size() == 2);
  CHECK(cuboid->dimensions[0].variable == "lit(a)");
  CHECK(cuboid->dimensions[0].interval.upper == 0.0);
  CHECK(cuboid->dimensions[1].interval.lower == 1.0);
  // Drawn values map back to the fluents.
  CHECK(lamps.wrong_at_start(fluents, {"Lit(b)"}, {{"lit(a)", 0.0}, {"lit(b)", 1.0}}).empty());
  // Two fluents that want different values of one variable.
  const auto both = lamps.start_cuboid({ground_fluent("Lit(a)"), ground_fluent("Dark()")},
                                       {"Dark()"}, {}, {}, sink);
  CHECK_FALSE(both.has_value());
  CHECK(sink.sorted().front().message.find("outside what `Lit(a)` asks for (0)") !=
        std::string::npos);
}

TEST_CASE("start: contradictions name the fluents") {
  auto found = start_errors({"RobotIn(r1)", "RobotIn(r2)", "In(box,r2)"});
  REQUIRE(found.size() == 1);
  CHECK(found[0].message ==
        "cannot draw a start state: `RobotIn(r1)` and `RobotIn(r2)` hold, but the regions `r1` and "
        "`r2` are disjoint");
  found = start_errors({"RobotIn(r1)", "In(robot,r3)"});
  CHECK(found.size() == 2);  // the robot, and the box that is nowhere
}

TEST_CASE("start: a body in no region needs a sampling range that keeps clear of them all") {
  const std::set<std::string> start{"RobotIn(r1)"};
  auto found = start_errors(start);
  REQUIRE(found.size() == 1);
  CHECK(found[0].message ==
        "cannot draw a start state: `box` is in none of its regions, and nothing says where "
        "`box.x` is instead");
  found = start_errors(start, {{"box.x", {2.5, 4}}});
  REQUIRE(found.size() == 1);
  CHECK(found[0].message ==
        "cannot draw a start state: `In(box,r3)` does not hold, but the sampling range of `box` "
        "reaches into `r3`");
  base::DiagnosticSink sink;
  CHECK(line().start_cuboid(all_fluents(), start, {{"box.x", {3.5, 4}}}, {}, sink).has_value());
}

TEST_CASE("cells: the expected final state pins bodies to regions, a held one to none") {
  const auto cells = line().cells(all_fluents(), {"RobotIn(r2)", "Holding(box)"});
  REQUIRE(cells.size() == 1);
  CHECK(cells.at("robot.x").lower == 1.0);
  const auto placed = line().cells(all_fluents(), {"RobotIn(r1)", "In(box,r3)"});
  REQUIRE(placed.size() == 2);
  CHECK(placed.at("box.x").closed);
}

TEST_CASE("check: unmapped symbols once, wrong arity, and regions that do not exist") {
  base::DiagnosticSink sink;
  CHECK_FALSE(line()
                  .check(fluents_of({"RobotOn(r1)", "RobotOn(r2)", "RobotIn(r4)", "Holding(a,b)",
                                     "RobotIn(r1)"}),
                         {base::FileId(0), 0, 0}, sink)
                  .has_value());
  const auto found = sink.sorted();
  REQUIRE(found.size() == 3);
  CHECK(found[0].message == "fluent `RobotOn` has no mapping to the simulated world");
  REQUIRE(found[0].notes.size() == 1);
  CHECK(found[0].notes[0].text == "`RobotIn` is mapped; is that the one?");
  CHECK(found[1].message == "fluent `RobotIn(r4)` speaks of region `r4`, which does not exist");
  CHECK(found[2].code == codes::kMappingArity);
  base::DiagnosticSink good;
  CHECK(line().check(all_fluents(), {}, good).has_value());
}

}  // namespace
}  // namespace parallax::harness
