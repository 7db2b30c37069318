// Impossible geometry in a whole scenario: one located message before anything is simulated.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/kitchen_copy.h"

namespace parallax::test {
namespace {

void check_refused(const KitchenCopy& cli, const std::string& place, const std::string& text) {
  for (const auto* command : {"check", "run", "rates"}) {
    CAPTURE(command);
    const auto result = cli.parallax({command, "kitchen/plan2.yaml"});
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

TEST_CASE("a drawer that is longer than its bay") {
  const KitchenCopy cli;
  // A box of one of the drawers goes through the back of the bay.
  cli.lay_over(
      "bodies: {drawer_mid: {shapes: [{size_m: [0.7, 0.4, 0.1], at_m: [0.1, 0, 0]}, "
      "{size_m: [0.016, 0.6, 0.016], at_m: [-0.325, 0, 0.05]}]}}");
  check_refused(cli, "world.yaml:", "joints/dMid/range_m: `drawer_mid` meets `cabinet`");
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
  cli.replace("kitchen/common.yaml", "start: {x: [1.41, 1.51], y: [0.06, 0.09], bottom: 0.85}",
              "start: {x: [1.41, 1.51], y: [0.06, 0.09], bottom: 0.865}");
  check_refused(cli, "common.yaml:", "regions/pw1: nothing in the world is below");
}

TEST_CASE("a region of the goals outside the world") {
  const KitchenCopy cli;
  cli.replace("kitchen/common.yaml", "pt4: {x: [-0.95, -0.72]", "pt4: {x: [-9.95, -9.72]");
  check_refused(cli, "common.yaml:", "regions/pt4: nothing in the world reaches into it");
}

TEST_CASE("a region of the robot that the plan's poses are not in") {
  const KitchenCopy cli;
  cli.replace("kitchen/common.yaml", "bWork: {x: [0.64, 0.80]", "bWork: {x: [40.64, 40.80]");
  check_refused(cli, "plan2.lisp:", "lies outside all regions of `region`");
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
