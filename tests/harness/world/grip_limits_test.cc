// The grips of which `check` warns are those that slipped in grip_table.txt, which
// parallax_grip_table made by simulating them. docs/internals/physics.md names them.

#include "harness/world/grip_limits.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "tests/harness/world/fetch_world.h"

namespace parallax::harness {
namespace {

constexpr double kPadFriction = 0.6, kSqueeze_n = 20.0, kEarth_m_s2 = 9.81;

std::vector<BodyShape> bowl(int sides) {
  constexpr double kWidth_m = 0.07, kWall_m = 0.008, kHeight_m = 0.06, kBottom_m = 0.04;
  std::vector<BodyShape> shapes = {
      {{kBottom_m, kBottom_m, kWall_m}, {0.0, 0.0, -0.5 * (kHeight_m - kWall_m)}}};
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    const double radius_m = 0.5 * (kWidth_m - kWall_m);
    shapes.push_back({{kWall_m, kWidth_m * std::tan(std::numbers::pi / sides), kHeight_m},
                      {radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0},
                      angle});
  }
  return shapes;
}

std::vector<BodyShape> shapes_of(const std::string& load) {
  if (load == "ring") return bowl(8);
  BodyShape shape{{0.07, 0.07, 0.07}};
  if (load == "cylinder") shape.form = ShapeForm::kCylinder;
  if (load == "hull" || load == "mesh") shape.form = ShapeForm::kHull;
  return {shape};
}

BodySpec& load_in(WorldSpec& spec) {
  for (auto& body : spec.bodies) {
    if (body.name == "box") return body;
  }
  FAIL("there is a box");
  return spec.bodies.front();
}

/// The robot on a line beside a load that its grip holds so many times at rest.
WorldSpec world_with(const std::string& load, EngineKind engine, double step_s, double margin) {
  auto spec = fetch_world();
  spec.engine = engine;
  spec.solver.timestep_s = step_s;
  auto& body = load_in(spec);
  body.shapes = shapes_of(load);
  body.mass_kg = 2.0 * kPadFriction * kSqueeze_n / (margin * kEarth_m_s2);
  return spec;
}

TEST_CASE("who slips in the measured table is warned of, and nobody else") {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/tests/harness/world/grip_table.txt");
  REQUIRE(in);
  std::ifstream in_page(std::string(PARALLAX_SOURCE_DIR) + "/docs/internals/physics.md");
  const std::string page{std::istreambuf_iterator<char>(in_page), {}};
  const std::regex row(
      R"(\| (box|cylinder|hull|mesh|ring) \| ([0-9.]+) ms \| (ode|mujoco) \| [^|]* \| \**(\d+) of (\d+)[^|]* \| \**(\d+) of .*)");
  int rows = 0, slips = 0;
  for (std::string line; std::getline(in, line);) {
    std::smatch part;
    if (!std::regex_match(line, part, row)) continue;
    CAPTURE(line);
    ++rows;
    const auto engine = part[3] == "ode" ? EngineKind::kOde : EngineKind::kMujoco;
    const double step_s = 0.001 * std::stod(part[2]);
    const int slipped = std::stoi(part[4]), runs = std::stoi(part[5]);
    const auto doubtful = doubtful_grips(world_with(part[1], engine, step_s, 2.0));
    REQUIRE(doubtful.size() == (slipped > 0 ? 1 : 0));
    const auto firm = doubtful_grips(world_with(part[1], engine, step_s, 5.01));
    CHECK(firm.empty() == (std::stoi(part[6]) == 0));
    if (slipped == 0) continue;
    ++slips;
    const auto cell = part[4].str() + " of " + part[5].str() + " |";
    CHECK(page.find("| " + part[1].str() + " | " + part[2].str() + " ms | " + part[3].str() +
                    " | " + cell) != std::string::npos);
    CHECK(doubtful[0].body == "box");
    CHECK(to_string(doubtful[0].form) == part[1].str());
    CHECK(doubtful[0].slipped == slipped);
    CHECK(doubtful[0].runs == runs);
    CHECK(doubtful[0].measured_s == step_s);
    // At the step that is named instead none of them slips.
    CHECK(doubtful_grips(world_with(part[1], engine, doubtful[0].sound_s, 2.0)).empty());
  }
  CHECK(rows == 40);
  CHECK(slips == 3);
}

TEST_CASE("between two measured steps the larger one counts") {
  const auto at = [](double step_s) {
    return doubtful_grips(world_with("cylinder", EngineKind::kMujoco, step_s, 2.0));
  };
  CHECK(at(0.0009).empty());
  REQUIRE(at(0.0015).size() == 1);
  CHECK(at(0.0015)[0].measured_s == 0.002);
  REQUIRE(at(0.003).size() == 1);
  CHECK(at(0.003)[0].measured_s == 0.004);
  REQUIRE(at(0.01).size() == 1);
  CHECK(at(0.01)[0].measured_s == 0.004);
}

TEST_CASE("a drawn mass and a given squeeze widen what a grip holds") {
  const auto at = [](double margin, const GripRange& range) {
    return doubtful_grips(world_with("ring", EngineKind::kOde, 0.004, margin), {{"box", range}})
        .size();
  };
  const auto mass_kg = [](double margin) {
    return 2.0 * kPadFriction * kSqueeze_n / (margin * kEarth_m_s2);
  };
  // Grips below a margin of 1 slip by the law, and those above 5 did not slip.
  CHECK(at(0.9, {}) == 0);
  CHECK(at(6.0, {}) == 0);
  CHECK(at(0.9, {mass_kg(2.0), mass_kg(0.5), {}, {}}) == 1);
  CHECK(at(6.0, {mass_kg(6.0), mass_kg(3.0), {}, {}}) == 1);
  CHECK(at(2.0, {mass_kg(8.0), mass_kg(6.0), {}, {}}) == 0);
  CHECK(at(6.0, {{}, {}, 0.5 * kSqueeze_n, kSqueeze_n}) == 1);
  CHECK(at(0.9, {{}, {}, kSqueeze_n, 2.0 * kSqueeze_n}) == 1);
}

/// A mobile robot beside two loads that its grasps squeeze with kSqueeze_n.
WorldSpec mobile_world() {
  auto spec = world_with("ring", EngineKind::kOde, 0.004, 6.0);
  spec.mobile.emplace();
  ArmSpec arm;
  arm.near_pad_body = "near_pad";
  arm.far_pad_body = "far_pad";
  spec.mobile->arms = {arm};
  spec.robot = {};
  auto& grasp = load_in(spec).grasp.emplace();
  grasp.width_m = 0.07;
  grasp.effort_n = kSqueeze_n;
  auto second = load_in(spec);
  second.name = "second";
  spec.bodies.push_back(second);
  return spec;
}

/// The squeezes of a body after an action; both are those of its grip if the action says nothing.
std::pair<double, double> squeezes(const WorldSpec& spec, std::string_view controller,
                                   const State& arguments, const std::string& body = "box") {
  std::map<std::string, GripRange> ranges;
  widen_by_action(spec, controller, arguments, ranges);
  const auto& range = ranges[body];
  return {range.gentlest_n.value_or(kSqueeze_n), range.firmest_n.value_or(kSqueeze_n)};
}

TEST_CASE("an action widens the squeeze of what it grips, not of handles") {
  using Range = std::pair<double, double>;
  const auto mobile = mobile_world();
  const Range own{kSqueeze_n, kSqueeze_n};
  for (const auto* controller : {"open-drawer", "open-door", "close-door"}) {
    CAPTURE(controller);
    CHECK(squeezes(mobile, controller, {{"effort_n", 90.0}}) == own);
    CHECK(squeezes(mobile, controller, {}) == own);
  }
  CHECK(squeezes(mobile, "pick-up", {}) == own);
  CHECK(squeezes(mobile, "pick-up", {{"effort_n", 8.0}}) == Range{8.0, kSqueeze_n});
  CHECK(squeezes(mobile, "regrip", {{"effort_n", 30.0}}) == Range{kSqueeze_n, 30.0});
  // The table of controllers has its force.
  CHECK(squeezes(mobile, "regrip", {}) == Range{kSqueeze_n, 40.0});

  const State named{{"effort_n", 8.0}, {"object", std::string("box")}};
  CHECK(squeezes(mobile, "pick-up", named) == Range{8.0, kSqueeze_n});
  CHECK(squeezes(mobile, "pick-up", named, "second") == own);
  const State open{{"effort_n", 8.0}, {"object", std::string("{item}")}};
  CHECK(squeezes(mobile, "pick-up", open, "second") == Range{8.0, kSqueeze_n});

  const auto line = world_with("ring", EngineKind::kOde, 0.004, 6.0);
  CHECK(squeezes(line, "picking-up", {}) == own);
  CHECK(squeezes(line, "picking-up", {{"grip_force_n", 8.0}}) == Range{8.0, kSqueeze_n});
}

TEST_CASE("loads without weight do not slip") {
  auto spec = world_with("cylinder", EngineKind::kMujoco, 0.004, 2.0);
  REQUIRE(doubtful_grips(spec).size() == 1);
  SUBCASE("none has any") { spec.solver.gravity_m_s2 = 0.0; }
  SUBCASE("this one has none") { load_in(spec).gravity = false; }
  CHECK(doubtful_grips(spec).empty());
}

TEST_CASE("what the pads do not close on is no part of a grip") {
  auto spec = world_with("ring", EngineKind::kOde, 0.004, 2.0);
  REQUIRE(doubtful_grips(spec).size() == 1);
  SUBCASE("nothing free") { load_in(spec).mass_kg = 0.0; }
  SUBCASE("a box of plates") { load_in(spec).shapes = bowl(4); }
  SUBCASE("one wall of the ring, which is a box") {
    // A mobile robot grips a body where its `grasp` says.
    spec.mobile.emplace();
    ArmSpec arm;
    arm.near_pad_body = "near_pad";
    arm.far_pad_body = "far_pad";
    spec.mobile->arms = {arm};
    spec.robot = {};
    auto& grasp = load_in(spec).grasp.emplace();
    grasp.width_m = 0.07;
    REQUIRE(doubtful_grips(spec).size() == 1);
    grasp.p_BG = {-0.031, 0.0, 0.02};
    grasp.width_m = 0.009;
  }
  SUBCASE("no robot") { spec.robot = {}; }
  CHECK(doubtful_grips(spec).empty());
}

}  // namespace
}  // namespace parallax::harness
