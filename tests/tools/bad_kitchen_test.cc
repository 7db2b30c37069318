// Impossible geometry in a whole scenario: one located message before anything is simulated.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/kitchen_copy.h"

namespace parallax::test {
namespace {

/// One error, at `place` in the kitchen's files, whichever command reads them; nothing is begun.
void check_refused_by(const KitchenCopy& cli, std::initializer_list<const char*> commands,
                      const std::string& scenario, const std::string& place,
                      const std::string& text) {
  for (const auto* command : commands) {
    CAPTURE(command);
    const auto result = cli.parallax({command, scenario});
    CAPTURE(result.err);
    CHECK(result.code == 3);
    CHECK(result.out.empty());
    CHECK(result.err.find("kitchen/" + place) != std::string::npos);
    CHECK(result.err.find(text) != std::string::npos);
    const auto first = result.err.find("error[");
    CHECK(result.err.find("error[", first + 1) == std::string::npos);
    CHECK_FALSE(std::filesystem::exists(cli.folder() / "out"));
  }
}

void check_refused(const KitchenCopy& cli, const std::string& place, const std::string& text) {
  check_refused_by(cli, {"check", "run", "rates"}, "kitchen/plan2.yaml", place, text);
}

/// `plan2.yaml` with something laid over it.
void check_overlay_refused(const std::string& overlay, const std::string& place,
                           const std::string& text) {
  const KitchenCopy cli;
  cli.write("kitchen/overlay.yaml", "include: plan2.yaml\n" + overlay + "\n");
  CAPTURE(overlay);
  check_refused_by(cli, {"check", "run"}, "kitchen/overlay.yaml", place, text);
}

TEST_CASE("a drawer that is longer than its bay") {
  const KitchenCopy cli;
  // A box of one of the drawers goes through the back of the bay.
  cli.lay_over(
      "bodies: {drawer_mid: {shapes: [{size_m: [0.7, 0.4, 0.1], at_m: [0.1, 0, 0]}, "
      "{size_m: [0.016, 0.6, 0.016], at_m: [-0.325, 0, 0.05]}]}}");
  check_refused(cli, "building.yaml:", "joints/dMid/range_m: `drawer_mid` meets `cabinet`");
}

TEST_CASE("a handle that no arm reaches") {
  const KitchenCopy cli;
  cli.lay_over(
      "bodies: {drawer_low: {shapes: [{size_m: [0.5, 0.4, 0.1], at_m: [0, 0, 0.05]}, "
      "{size_m: [0.016, 0.6, 0.016], at_m: [-0.325, 0, 3]}]}}\n"
      "  joints: {dLow: {handle: {at_m: [-0.325, -0.2, 3]}}}");
  check_refused(cli, "common.yaml:", "joints/dLow/handle: is ");
}

TEST_CASE("a handle far behind its drawer") {
  const KitchenCopy cli;
  cli.lay_over("joints: {dLow: {handle: {at_m: [0.9, -0.2, 0.05]}}}");
  check_refused(cli, "common.yaml:", "joints/dLow/handle: there is nothing of `drawer_low`");
}

TEST_CASE("a region of the starts in the air") {
  const KitchenCopy cli;
  cli.replace("kitchen/household.yaml", "start: {x: [1.41, 1.51], y: [0.06, 0.09], bottom: 0.85}",
              "start: {x: [1.41, 1.51], y: [0.06, 0.09], bottom: 0.865}");
  check_refused(cli, "household.yaml:", "regions/pw1: nothing in the world is below");
}

TEST_CASE("a region of the goals outside the world") {
  const KitchenCopy cli;
  cli.replace("kitchen/household.yaml", "pt4: {x: [-0.95, -0.72]", "pt4: {x: [-9.95, -9.72]");
  check_refused(cli, "household.yaml:", "regions/pt4: nothing in the world reaches into it");
}

TEST_CASE("a region of the robot that the plan's poses are not in") {
  const KitchenCopy cli;
  cli.replace("kitchen/household.yaml", "bWork: {x: [0.64, 0.80]", "bWork: {x: [40.64, 40.80]");
  check_refused(cli, "plan2.lisp:", "lies outside all regions of `region`");
}

TEST_CASE("arguments of actions that the world or the controller does not know") {
  check_overlay_refused("actions: {\"OpenDrawer(arm, drawer)\": {arm: middle}}",
                        "overlay.yaml:2:", "`middle`, which does not name an arm");
  check_overlay_refused("actions: {\"CloseDrawer(arm, drawer)\": {joint: dLov}}",
                        "overlay.yaml:2:", "`dLow`");
  check_overlay_refused("actions: {Go(base): {place: \"{base}s\"}}",
                        "overlay.yaml:2:", "does not name a place");
  check_overlay_refused("actions: {Detect(itype): {kind: spoooon}}",
                        "overlay.yaml:2:", "is no kind of a free body");
}

TEST_CASE("numbers of actions beyond their bounds") {
  check_overlay_refused("actions: {Go(base): {sweep_step_m: 0}}",
                        "overlay.yaml:2:", "is 0, but must be from 0.001 to 1");
  check_overlay_refused("actions: {Go(base): {max_speed_m_s: 0}}",
                        "overlay.yaml:2:", "is 0, but must be above 0");
  check_overlay_refused("actions: {Detect(itype): {points: 1000000000}}",
                        "overlay.yaml:2:", "is 1e+09, but must be a whole number from 1 to 1000");
  check_overlay_refused("actions: {Detect(itype): {points: 3, points_needed: 9}}",
                        "overlay.yaml:2:", "is 9, above the 3 of `points`");
}

TEST_CASE("numbers of the plan beyond their bounds are known before the first simulation") {
  const KitchenCopy cli;
  cli.replace("kitchen/household.yaml", "from_plan: {target: target, speed: max_speed_m_s}",
              "from_plan: {target.x: max_speed_m_s}");
  const auto result = cli.parallax({"run", "kitchen/plan2.yaml"});
  CAPTURE(result.err);
  CHECK(result.code == 3);
  CHECK(result.err.find("error[E5126]: `max_speed_m_s` of `Go(bTable)`: is -0.1") !=
        std::string::npos);
  CHECK(result.err.find("plan2.lisp") != std::string::npos);
}

TEST_CASE("a speed of the plan at which a step is longer than a shape is thick is warned of") {
  const KitchenCopy cli;
  CHECK(cli.parallax({"check", "kitchen/plan2_modified.yaml"}).err.find("W5138") ==
        std::string::npos);
  cli.replace("kitchen/plan2_modified.lisp", "(speed 0.25)", "(speed 9)");
  const auto result = cli.parallax({"check", "kitchen/plan2_modified.yaml"});
  CAPTURE(result.err);
  CHECK(result.code == 0);
  CHECK(result.err.find("household.yaml:82:3") != std::string::npos);
  CHECK(result.err.find("warning[W5138]: `max_speed_m_s` of `Go(bTable)`, by the plan: 9 m/s are "
                        "36 mm in a step of 4 ms, but `bowl1` has a shape of 5 mm") !=
        std::string::npos);
}

TEST_CASE("grippers that cannot hold what there is to hold") {
  check_overlay_refused("world: {bodies: {spoon1: {grasp: {width_m: 0.5}}}}",
                        "overlay.yaml:2:", "is 0.5 m, but no gripper opens wider than 0.09 m");
  check_overlay_refused("world: {joints: {dMid: {handle: {width_m: 0.5}}}}",
                        "overlay.yaml:2:", "joints/dMid/handle/width_m");
  check_overlay_refused("world: {robot: {arms: {left: {opening_m: 5}}}}",
                        "overlay.yaml:2:", "`left_finger` takes the pads from 0.001 to 0.1 m");
  check_overlay_refused("world: {joints: {left_finger: {range_m: [-0.001, 0.001]}}}",
                        "overlay.yaml:2:", "lets the pads hold nothing");
}

TEST_CASE("a mass that no household thing of that size has is warned of, also where it is drawn") {
  const KitchenCopy cli;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"world: {bodies: {cereal1: {mass_kg: 25}}}",
       "bodies/cereal1/mass_kg makes `cereal1` a thing of 1.3e+04 kg/m3: no household thing weighs "
       "so much"},
      {"sampling: {variables: {milk1.mass: [0.001, 1]}}",
       "0.001 kg makes `milk1` a thing of 0.9718 kg/m3: no household thing weighs so little"}};
  for (const auto& [overlay, text] : cases) {
    CAPTURE(overlay);
    cli.write("kitchen/overlay.yaml", "include: plan2.yaml\n" + overlay + "\n");
    const auto result = cli.parallax({"check", "kitchen/overlay.yaml"});
    CAPTURE(result.err);
    CHECK(result.code == 0);
    CHECK(result.err.find("overlay.yaml:2:") != std::string::npos);
    CHECK(result.err.find("warning[W5136]") != std::string::npos);
    CHECK(result.err.find(text) != std::string::npos);
  }
}

TEST_CASE("a squeeze that no gripper's motor can exert, or not that of the arm that is to") {
  check_overlay_refused("world: {bodies: {spoon1: {grasp: {effort_n: 1000}}}}", "overlay.yaml:2:",
                        "is 1000 N, but no gripper's motor exerts more than 60 N");
  check_overlay_refused("world: {robot: {arms: {left: {grip_force_n: 61}}}}", "overlay.yaml:2:",
                        "is 61 N, more than the 60 N (max_force_n) of `left_finger`");
  const KitchenCopy cli;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"actions: {\"PickUp(arm, item)\": {effort_n: 61}}",
       "effort_n: is 61 N, more than the 60 N (max_force_n) of `left_finger`"},
      {"world: {joints: {left_finger: {max_force_n: 50}}}",
       "arm: is `left`: the 60 N of `effort_n` are more than the 50 N"},
      {"world: {joints: {left_finger: {max_force_n: 5}}, robot: {arms: {left: {grip_force_n: 5}}}, "
       "bodies: {spoon1: {grasp: {effort_n: 6}}}}\n"
       "actions: {\"OpenDrawer(arm, drawer)\": {effort_n: 5}}",
       "object: is `spoon1`, whose grasp asks for 6 N (effort_n), more than the 5 N"}};
  for (const auto& [overlay, text] : cases) {
    CAPTURE(overlay);
    cli.write("kitchen/overlay.yaml", "include: plan2.yaml\n" + overlay + "\n");
    for (const auto* command : {"check", "run"}) {
      const auto result = cli.parallax({command, "kitchen/overlay.yaml"});
      CAPTURE(result.err);
      CHECK(result.code == 3);
      CHECK(result.err.find(text) != std::string::npos);
    }
    std::filesystem::remove_all(cli.folder() / "out");
  }
}

TEST_CASE("a camera that sees nothing") {
  for (const auto* camera : {"half_angle_rad: 1.6", "range_m: [-3, -1]", "range_m: [2.5, 0.3]",
                             "tilt_rad: [1.29, -0.37]", "at_m: [0.07, 0, -9]"}) {
    check_overlay_refused("world: {robot: {camera: {" + std::string(camera) + "}}}",
                          "overlay.yaml:2:", "robot/camera/");
  }
}

TEST_CASE("numbers that are no physics") {
  for (const auto* solver : {"contact_erp: 7", "contact_cfm: 3", "gravity_m_s2: 9.81",
                             "gravity_m_s2: -1000000000000.0"}) {
    check_overlay_refused("world: {solver: {" + std::string(solver) + "}}",
                          "overlay.yaml:2:", "solver/");
  }
  check_overlay_refused("world: {bodies: {bowl1: {mass_kg: 1e30}}}",
                        "overlay.yaml:2:", "is more than 1e+06 kg");
  check_overlay_refused("sampling: {variables: {milk1.mass: [0, 1]}}",
                        "overlay.yaml:2:", "must be above 0");
}

TEST_CASE("joints that do not move as the mapping says") {
  check_overlay_refused("world: {joints: {dMid: {range_m: [0, 0]}}}",
                        "overlay.yaml:2:", "leaves the slider no way to move");
  check_overlay_refused("world: {joints: {lift: {range_m: [0.3, -0.02]}}}",
                        "overlay.yaml:2:", "is reversed");
  check_overlay_refused(
      "mapping: {DrawerOpen(drawer): {range: \"{drawer}.q\", holds: [0.80, 0.96], "
      "fails: [-0.01, 0.03]}}",
      "overlay.yaml:2:", "mapping/DrawerOpen/holds: is from 0.8 to 0.96");
}

TEST_CASE("regions where no body can be") {
  const auto surface = [](const std::string& text) {
    return "regions: {sets: {surfaces: {cells: {" + text + "}}}}";
  };
  check_overlay_refused(surface("pt4: {bottom: [-5, -4]}"),
                        "overlay.yaml:2:", "lies below the floor");
  check_overlay_refused(surface("pt4: {bottom: [0.3, 0.5]}"),
                        "overlay.yaml:2:", "lies inside `table`");
  check_overlay_refused(surface("pw1: {start: {bottom: 0.835}}"),
                        "overlay.yaml:2:", "its start lies inside `cabinet`");
  check_overlay_refused(surface("pw1: {start: {x: [1.51, 1.41]}}"),
                        "overlay.yaml:2:", "is reversed: 1.51 is above 1.41");
}

TEST_CASE("bodies that overlap whatever start is drawn") {
  check_overlay_refused(
      "world: {bodies: {table2: {material: wood, size_m: [0.81, 2.58, 0.86], "
      "position_m: [-1.065, 1.69, 0.43]}}}",
      "overlay.yaml:2:", "occupies the same place as `table`");
  check_overlay_refused("world: {bodies: {drawer_mid: {position_m: [1.54, 0.90, 0.36]}}}",
                        "building.yaml:", "overlaps `drawer_");
  check_overlay_refused(
      "world: {bodies: {ball: {size_m: [0.1, 0.1, 0.1], mass_kg: 1, "
      "position_m: [-1.0, 1.5, 0.43]}}}",
      "overlay.yaml:2:", "overlaps `table` at every start");
  check_overlay_refused(
      "world: {bodies: {base: {shapes: [{size_m: [0.66, 0.66, 0.57], "
      "at_m: [0, 0, 0.1]}]}}}",
      "overlay.yaml:2:", "overlaps `floor` at every start");
}

TEST_CASE("a heavy free body before a drawer is none of these: it can be moved") {
  const KitchenCopy cli;
  cli.lay_over(
      "bodies: {crate: {size_m: [0.2, 0.5, 0.6], mass_kg: 500, material: wood, "
      "position_m: [1.05, 0.9, 0.301]}}");
  CHECK(cli.parallax({"check", "kitchen/plan2.yaml"}).code == 0);
}

TEST_CASE("a pose beside its region in height is told apart from one in it") {
  const KitchenCopy cli;
  cli.write("kitchen/overlay.yaml",
            "include: plan1.yaml\n"
            "regions: {sets: {surfaces: {cells: {pt1: {bottom: [0.9, 1.0]}}}}}\n");
  const auto result = cli.parallax({"check", "kitchen/overlay.yaml"});
  CAPTURE(result.err);
  CHECK(result.code == 3);
  CHECK(result.err.find("0.04 m away (bottom: 0.86 is not from 0.9 to 1)") != std::string::npos);
}

TEST_CASE("starts that always interpenetrate: a bounded number, and the pair that collides") {
  const KitchenCopy cli;
  cli.lay_over(
      "bodies: {block: {size_m: [0.2, 0.2, 0.2], mass_kg: 0, material: wood, "
      "position_m: [0.72, 0.06, 0.3]}}");
  for (const auto* command : {"run", "rates"}) {
    CAPTURE(command);
    const auto result = cli.parallax({command, "kitchen/plan2.yaml"});
    CAPTURE(result.err);
    CHECK(result.code == 3);
    // At the region that the robot is put into, with a note at the block.
    CHECK(result.err.find("`base` is put into `bWork`") != std::string::npos);
    CHECK(result.err.find("`block` stands here") != std::string::npos);
    for (const auto* part : {"common.yaml:", "100 starts in a row", "`base`", "`block`"}) {
      CAPTURE(part);
      CHECK(result.err.find(part) != std::string::npos);
    }
  }
}

TEST_CASE("what was found before an error in a later trace is reported all the same") {
  const KitchenCopy cli;
  // Nothing holds the spoon: trace 1 goes wrong. In trace 2 it lies in the floor of its drawer.
  cli.write("kitchen/late.yaml",
            "include: plan2.yaml\n"
            "world: {friction: {spoon-pad: 0}}\n"
            "regions: {sets: {drawers: {cells: {dMid: {bottom: [-0.05, 0.07], "
            "start: {bottom: -0.006}}}}}}\n");
  const auto found = json_of(cli, {"run", "kitchen/late.yaml", "--keep-going", "--out", "out"}, 3);
  CHECK(found.at("status") == "error");
  CHECK(found.at("verdict") == "discrepancy");
  CHECK(found.at("traces").size() == 1);
  CHECK(found.at("discrepancies").at(0).at("trace") == 1);
  CHECK(found.at("diagnostics").dump().find("100 starts in a row") != std::string::npos);
  CHECK(cli.read("out/report.txt").find("an error ended the run") != std::string::npos);
  CHECK(cli.parallax({"replay", "out"}).code == 0);
}

}  // namespace
}  // namespace parallax::test
