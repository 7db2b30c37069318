#include <doctest/doctest.h>

#include "harness/region/state_mapping.h"

namespace parallax::harness {
namespace {

Region region(std::string name, std::initializer_list<std::pair<RegionAxis, Interval>> bounds) {
  Region out;
  out.name = std::move(name);
  for (const auto& [axis, interval] : bounds) out.on(axis) = interval;
  return out;
}

RegionSet region_set(std::vector<Region> regions) {
  base::DiagnosticSink sink;
  auto set = RegionSet::make(std::move(regions), true, sink);
  REQUIRE(set.has_value());
  return *set;
}

/// A floor with two rooms, two drawers whose insides move with them, and a shelf.
StateMapping kitchen_mapping() {
  const Interval inside{-0.2, 0.2};
  Region upper =
      region("upper",
             {{RegionAxis::kX, inside}, {RegionAxis::kY, inside}, {RegionAxis::kBottom, {0, 0.1}}});
  upper.frame = "drawer_u";
  upper.frame_start = {1.5, 1.0, 0.7};
  upper.start[static_cast<std::size_t>(RegionAxis::kBottom)] = Interval{0.0, 0.0};
  Region lower = upper;
  lower.name = "lower";
  lower.frame = "drawer_l";
  lower.frame_start = {1.5, 1.0, 0.5};
  std::vector<RegionFamily> families;
  families.push_back(
      {"rooms",
       region_set({region("hall", {{RegionAxis::kX, {0, 1}}, {RegionAxis::kYaw, {-0.1, 0.1}}}),
                   region("den", {{RegionAxis::kX, {2, 3}}, {RegionAxis::kYaw, {-0.1, 0.1}}})}),
       {"region"}});
  families.push_back({"drawers", region_set({upper, lower}), {"place"}});
  families.push_back(
      {"shelf",
       region_set({region("shelf", {{RegionAxis::kX, {0, 1}}, {RegionAxis::kBottom, {0.9, 1.1}}})}),
       {"place"}});
  RangeBinding open{"{0}.q", {0.40, 0.46}, {-0.01, 0.03}, 0.0};
  return StateMapping(RegionMap(std::move(families)),
                      {{"RobotAt", 1, InsideBinding{"robot", 0, {}, {}, true}, {}},
                       {"At", 2, InsideBinding{"{0}", 1, "{0}.held", {}, true}, {}},
                       {"Open", 1, open, {}},
                       {"LooksAt", 1, EqualsBinding{"robot.looking_at", "{0}"}, {}},
                       {"Parked", 0, FlagBinding{"parked", true}, {}}});
}

std::vector<GroundFluent> fluents() {
  std::vector<GroundFluent> all;
  for (const char* text :
       {"RobotAt(hall)", "RobotAt(den)", "At(cup,upper)", "At(cup,lower)", "At(cup,shelf)",
        "Open(u)", "LooksAt(hall)", "LooksAt(den)", "Parked()"}) {
    all.push_back(ground_fluent(text));
  }
  return all;
}

State state() {
  return {{"robot.x", 0.5},    {"robot.yaw", 0.0},
          {"cup.x", 1.4},      {"cup.y", 1.0},
          {"cup.bottom", 0.7}, {"cup.held", false},
          {"drawer_u.x", 1.5}, {"drawer_u.y", 1.0},
          {"drawer_u.z", 0.7}, {"drawer_u.yaw", 0.0},
          {"drawer_l.x", 1.5}, {"drawer_l.y", 1.0},
          {"drawer_l.z", 0.5}, {"drawer_l.yaw", 0.0},
          {"u.q", 0.0},        {"robot.looking_at", std::string("den")},
          {"parked", true}};
}

bool holds(const State& at, const char* text) {
  return kitchen_mapping().holds(ground_fluent(text), at).value();
}

TEST_CASE("a drawer between open and closed is neither") {
  State at = state();
  const auto read = [&](double q) {
    at["u.q"] = q;
    return kitchen_mapping().read(ground_fluent("Open(u)"), at).value();
  };
  CHECK(read(0.0) == Reading::kFails);
  CHECK(read(0.03) == Reading::kFails);
  CHECK(read(0.031) == Reading::kNeither);
  CHECK(read(0.2) == Reading::kNeither);
  CHECK(read(0.399) == Reading::kNeither);
  CHECK(read(0.40) == Reading::kHolds);
  CHECK(read(0.45) == Reading::kHolds);
  CHECK(read(0.5) == Reading::kNeither);
}

TEST_CASE("a region in the frame of a drawer moves and turns with it") {
  State at = state();
  CHECK(holds(at, "At(cup,upper)"));
  CHECK_FALSE(holds(at, "At(cup,lower)"));
  at["drawer_u.x"] = 1.05;  // pulled out without the cup
  CHECK_FALSE(holds(at, "At(cup,upper)"));
  at["cup.x"] = 0.95;
  CHECK(holds(at, "At(cup,upper)"));
  at["drawer_u.yaw"] = 0.7853981633974483;
  at["cup.x"] = 1.05 + 0.25;  // on the diagonal, which now lies along x
  at["cup.y"] = 1.0;
  CHECK(holds(at, "At(cup,upper)"));
  at["drawer_u.yaw"] = 0.0;
  CHECK_FALSE(holds(at, "At(cup,upper)"));
  at["cup.bottom"] = 0.5;
  at["cup.x"] = 1.5;
  CHECK(holds(at, "At(cup,lower)"));
}

TEST_CASE("a region of a robot asks for its heading, too") {
  State at = state();
  CHECK(holds(at, "RobotAt(hall)"));
  at["robot.yaw"] = 0.5;
  CHECK_FALSE(holds(at, "RobotAt(hall)"));
  CHECK(kitchen_mapping().outside(fluents(), at) == std::vector<std::string>{"RobotAt(outside)"});
}

TEST_CASE("what is in no region is outside, unless it is held") {
  State at = state();
  CHECK(kitchen_mapping().outside(fluents(), at).empty());
  at["cup.bottom"] = 0.0;  // on the floor, which has no region here
  CHECK(kitchen_mapping().outside(fluents(), at) == std::vector<std::string>{"At(cup,outside)"});
  at["cup.held"] = true;
  CHECK(kitchen_mapping().outside(fluents(), at).empty());
  CHECK(kitchen_mapping().outside_text(ground_fluent("At(cup,upper)")) == "At(cup,outside)");
  CHECK(kitchen_mapping().outside_text(ground_fluent("Open(u)")).empty());
}

TEST_CASE("a text variable picks one constant") {
  CHECK(holds(state(), "LooksAt(den)"));
  CHECK_FALSE(holds(state(), "LooksAt(hall)"));
}

TEST_CASE("a start in a drawer is drawn where the drawer is after a reset") {
  base::DiagnosticSink sink;
  const std::set<std::string> start = {"RobotAt(hall)", "At(cup,lower)", "Parked()"};
  const auto cuboid = kitchen_mapping().start_cuboid(fluents(), start, {}, {}, sink);
  REQUIRE(cuboid.has_value());
  std::map<std::string, Interval> by_name;
  for (const auto& dimension : cuboid->dimensions) by_name[dimension.variable] = dimension.interval;
  CHECK(by_name.at("cup.x").lower == doctest::Approx(1.3));
  CHECK(by_name.at("cup.y").upper == doctest::Approx(1.2));
  CHECK(by_name.at("cup.bottom").lower == doctest::Approx(0.5));
  CHECK(by_name.at("cup.bottom").upper == by_name.at("cup.bottom").lower);
  State drawn = {
      {"robot.x", 0.5}, {"robot.yaw", 0.0}, {"cup.x", 1.4}, {"cup.y", 1.0}, {"cup.bottom", 0.5}};
  CHECK(kitchen_mapping().wrong_at_start(fluents(), start, drawn).empty());
  drawn["cup.x"] = 1.0;
  CHECK(kitchen_mapping().wrong_at_start(fluents(), start, drawn) ==
        std::vector<std::string>{"At(cup,lower)"});
}

TEST_CASE("a start that a reset does not make is refused") {
  for (const std::set<std::string>& start :
       {std::set<std::string>{"RobotAt(hall)", "At(cup,lower)"},  // not parked
        std::set<std::string>{"RobotAt(hall)", "At(cup,lower)", "Parked()", "Open(u)"},
        std::set<std::string>{"RobotAt(hall)", "At(cup,lower)", "Parked()", "LooksAt(den)"}}) {
    base::DiagnosticSink sink;
    CHECK_FALSE(kitchen_mapping().start_cuboid(fluents(), start, {}, {}, sink).has_value());
    CHECK(sink.error_count() == 1);
  }
}

TEST_CASE("functions of a plan ask the sets that are meant for them") {
  const StateMapping m = kitchen_mapping();
  const Point low = {0.5, 0.0, 0.0, 0.0, 0.0};
  const Point high = {0.5, 0.0, 1.0, 0.0, 1.0};
  REQUIRE(m.regions().locate("region", low) != nullptr);
  CHECK(m.regions().locate("region", low)->name == "hall");
  CHECK(m.regions().locate("place", low) == nullptr);
  REQUIRE(m.regions().locate("place", high) != nullptr);
  CHECK(m.regions().locate("place", high)->name == "shelf");
  CHECK(m.regions().locate("gaze", high) == nullptr);
}

}  // namespace
}  // namespace parallax::harness
