// A world in MJCF from the command line: fetched in, drawn, replayed, refused.

#include <doctest/doctest.h>

#include <array>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_fixture.h"
#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

/// Does this build have it? Says so where it does not.
bool lacks(const CliFixture& cli, const std::string& name) {
  const auto document = nlohmann::json::parse(cli.parallax({"doctor", "--json"}).out);
  for (const auto& check : document.at("checks")) {
    if (check.at("name") == name && check.at("health") == "works") return false;
  }
  std::cout << "SKIPPED: this build has no " << name << "\n";
  return true;
}

/// The world of two_regions, its robot included, as MuJoCo would have it.
constexpr const char* kLane = R"(<mujoco>
  <default>
    <geom type="box" friction="0.5 0.005 0.0001"/>
    <joint type="slide" limited="true"/>
    <default class="pad"><geom size="0.01 0.005 0.025" mass="0.1"/></default>
  </default>
  <worldbody>
    <geom name="ground" type="plane" size="0 0 1"/>
    <body name="base" pos="0.5 -0.6 0.2">
      <joint name="drive" axis="1 0 0" range="-1 2.5"/>
      <geom size="0.25 0.2 0.15" density="480"/>
      <geom size="0.05 0.05 0.125" pos="0 0 0.275" density="480"/>
      <body name="arm" pos="0 0.3 0.3">
        <joint name="reach" axis="1 0 0" range="-0.6 0.6"/>
        <geom size="0.03 0.3 0.03" mass="3"/>
        <body name="palm" pos="0 0.3 -0.195">
          <joint name="lift" axis="0 0 1" range="-0.21 0.05"/>
          <geom size="0.03 0.08 0.02" mass="0.6"/>
          <body name="near_pad" pos="0 -0.05 -0.065"><geom class="pad"/></body>
          <body name="far_pad" pos="0 0.05 -0.065">
            <joint name="finger" axis="0 1 0" range="-0.085 0"/><geom class="pad"/>
          </body>
        </body>
      </body>
    </body>
    <body name="box" pos="1.5 0 0.035"><freejoint/><geom size="0.035 0.035 0.035" mass="0.3"/></body>
  </worldbody>
</mujoco>
)";

/// Keys for what MJCF cannot express: roles, forces of motors, variables that a start sets.
constexpr const char* kRoles = R"(mjcf: lane.xml
friction: {default: 0.5, box-floor: 0.5, box-pad: 0.6}
floor_material: floor
bodies:
  base: {material: steel, settable: [x]}
  arm: {material: steel}
  palm: {material: steel}
  near_pad: {material: pad}
  far_pad: {material: pad}
  box: {material: box, settable: [x, y, yaw]}
joints:
  drive: {max_force_n: 400}
  reach: {max_force_n: 200}
  lift: {max_force_n: 200}
  finger: {max_force_n: 20}
robot:
  base_joint: drive
  base_body: base
  reach_joint: reach
  lift_joint: lift
  finger_joint: finger
  near_pad_body: near_pad
  far_pad_body: far_pad
  grip_force_n: 20
  opening_m: 0.09
)";

TEST_CASE("a robot in MJCF that is given roles fetches a box of MJCF, in both engines") {
  const CliFixture cli;
  if (lacks(cli, "MJCF")) return;
  cli.write("lane.xml", kLane);
  cli.write("world.yaml", kRoles);
  const auto drawn = cli.parallax({"draw", "scenario.yaml", "-o", "scene.svg"});
  CAPTURE(drawn.err);
  CHECK(drawn.code == 0);
  CHECK(cli.read("scene.svg").find("far_pad") != std::string::npos);
  for (const bool in_mujoco : {false, true}) {
    if (in_mujoco)
      cli.write("scenario.yaml", cli.read("scenario.yaml") + "simulator: {engine: mujoco}\n");
    const std::string out = in_mujoco ? "other" : "out";
    const auto run =
        cli.parallax({"run", "scenario.yaml", "--out", out, "--jobs", "2", "--epsilon", "0.2"});
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.code == 0);
    CHECK(cli.parallax({"replay", out}).code == 0);
  }
  CHECK_FALSE(std::filesystem::exists(cli.folder() / "MUJOCO_LOG.TXT"));
}

TEST_CASE(
    "what a world in MJCF cannot be is one located message, exit code 3, and leaves nothing") {
  const CliFixture cli;
  if (lacks(cli, "MJCF")) return;
  cli.write("world.yaml", kRoles);
  for (const auto& [from, to, said] : std::vector<std::array<std::string, 3>>{
           {"<freejoint/>", "<freejoint/><joint name='more'/>", "lane.xml:26:52-70: error[E5143]"},
           {"mass=\"0.3\"", "mass=\"-0.3\"", "lane.xml:26:52-94: error[E5143]"},
           {"<default>\n", "<include file='../secret.xml'/><default>\n",
            "lane.xml:2:3-32: error[E5143]: the file cannot be taken over: `../secret.xml` is "
            "not"}}) {
    cli.write("lane.xml", kLane);
    cli.replace("lane.xml", from, to);
    const auto before = files_below(cli.folder());
    const auto result = cli.parallax({"check", "scenario.yaml"});
    CAPTURE(result.err);
    CHECK(result.code == 3);
    CHECK(result.err.find(said) != std::string::npos);
    CHECK(files_below(cli.folder()) == before);
  }
}

}  // namespace
}  // namespace parallax::test
