// Arms of joints and their fast model, palms on gantries: kitchen and warehouse give the same
// verdicts with both. The bodies and grippers are the same; nothing else of the two is.

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/harness/arms/arm_robot.h"

namespace parallax::harness {
namespace {

const std::vector<std::string> kModels = {"arms", "palms"};

bool ok(const Outcome& outcome) { return outcome.status == SimStatus::kOk; }

State left_with(const std::string& key, const std::string& value) {
  return {{"arm", std::string("left")}, {key, value}};
}

/// Brings both parts into the shelf as the plan does. Returns the action that failed first; empty:
/// none.
std::string restock(const std::string& scenario) {
  Robot robot(world_of(scenario));
  struct Part {
    std::string name, arm, bin, slot;
  };
  const std::vector<Part> parts = {{"crate", "left", "binA", "slot1"},
                                   {"drum", "right", "binB", "slot2"}};
  for (const Part& part : parts) {
    robot.find(part.bin, part.name);
    if (!ok(robot.act("pick-up",
                      {{"arm", part.arm}, {"object", part.name}, {"standoff_m", 0.15}}))) {
      return "pick-up " + part.name;
    }
    if (!ok(robot.act("park", {{"arm", part.arm}}))) return "park " + part.name;
  }
  if (!ok(robot.act("drive", {{"place", std::string("atShelf")}}))) return "drive";
  for (const Part& part : parts) {
    if (!ok(robot.act("place", {{"arm", part.arm}, {"object", part.name}, {"place", part.slot}}))) {
      return "place " + part.name;
    }
    if (!ok(robot.act("park", {{"arm", part.arm}}))) return "park after " + part.name;
    CHECK(robot.number(part.name + ".z") > 0.80);
    CHECK(robot.number(part.name + ".x") < -1.56);
  }
  return {};
}

TEST_CASE("the warehouse: the shelf is filled, and with oily pads nothing leaves the bin") {
  for (const std::string& model : kModels) {
    CAPTURE(model);
    CHECK(restock("arms/warehouse_" + model + ".yaml") == "");
    CHECK(restock("arms/oily_pads_" + model + ".yaml") == "pick-up crate");
  }
}

/// Carries a carton of so much to the table.
bool arrives(const WorldSpec& spec, double mass_kg) {
  Robot robot(spec, {{"robot.x", 0.72}, {"robot.y", 0.06}, {"milk1.mass", mass_kg}});
  robot.find("pw1", "milk");
  REQUIRE(ok(robot.act("pick-up", left_with("object", "milk1"))));
  REQUIRE(ok(robot.act("park", {{"arm", std::string("left")}})));
  REQUIRE(robot.flag("milk1.held_by.left"));
  REQUIRE(ok(robot.act("drive", {{"place", std::string("bTable")}})));
  return robot.flag("milk1.held_by.left");
}

TEST_CASE(
    "the kitchen: a full carton slips on the way to the table, one that is not full arrives") {
  for (const std::string& model : kModels) {
    CAPTURE(model);
    const WorldSpec spec = world_of("arms/kitchen_plan1_" + model + ".yaml");
    CHECK(arrives(spec, 0.8));
    CHECK_FALSE(arrives(spec, 1.045));
  }
}

TEST_CASE("the kitchen: drawers are opened and shut, and an open one is in the way, or not") {
  for (const std::string& model : kModels) {
    CAPTURE(model);
    const WorldSpec spec = world_of("arms/kitchen_plan2_" + model + ".yaml");
    for (const std::string drawer : {"dTop", "dMid", "dLow"}) {
      CAPTURE(drawer);
      Robot robot(spec, {{"robot.x", 0.72}, {"robot.y", 0.06}});
      REQUIRE(ok(robot.act("open-drawer", left_with("joint", drawer))));
      CHECK(robot.number(drawer + ".q") > 0.44);
      REQUIRE(ok(robot.act("park", {{"arm", std::string("left")}})));
      REQUIRE(ok(robot.act("close-drawer", left_with("joint", drawer))));
      CHECK(robot.number(drawer + ".q") < 0.02);
      REQUIRE(ok(robot.act("park", {{"arm", std::string("left")}})));
    }
    for (const bool near : {true, false}) {
      CAPTURE(near);
      Robot robot(spec, near ? State{{"robot.x", 0.80}, {"robot.y", 0.14}}
                             : State{{"robot.x", 0.66}, {"robot.y", 0.0}});
      REQUIRE(ok(robot.act("open-drawer", left_with("joint", "dMid"))));
      REQUIRE(ok(robot.act("park", {{"arm", std::string("left")}})));
      const Outcome leaving = robot.act("drive", {{"place", std::string("bTable")}});
      CHECK(ok(leaving) == !near);
      if (near) {
        CHECK(leaving.reason == "navigation-pose-unreachable: `base` would meet `drawer_mid`");
      }
    }
  }
}

}  // namespace
}  // namespace parallax::harness
