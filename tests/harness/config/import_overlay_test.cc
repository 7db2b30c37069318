// Keys of a scenario that override an imported world, and stops that such a world cannot have.

#include <algorithm>
#include <memory>

#include "harness/engine/engine_module.h"
#include "tests/harness/config/mjcf_text.h"

namespace parallax::harness::test {
namespace {

struct Format {
  const char* key;
  bool (*is_there)();
  std::string file;
};

std::string link_in_urdf(const std::string& name) {
  return "<link name='" + name +
         "'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' "
         "iyz='0'/></inertial><collision><geometry><box size='0.2 0.2 0.2'/></geometry>"
         "</collision></link>\n";
}
std::string link_in_sdf(const std::string& name, double height_m) {
  return "<link name='" + name + "'><pose>0 0 " + std::to_string(height_m) +
         " 0 0 0</pose><collision name='c'><geometry><box><size>0.2 0.2 0.2</size></box></geometry>"
         "</collision></link>\n";
}

/// A body `hull` that stands, and `leaf`, 1 m above it, on a joint `swing` of this type.
std::vector<Format> with_joint(bool turns, const std::string& low, const std::string& high) {
  const std::string urdf =
      "<robot name='r'>\n" + link_in_urdf("hull") + link_in_urdf("leaf") +
      "<joint name='swing' type='" + (turns ? "revolute" : "prismatic") +
      "'><parent link='hull'/><child link='leaf'/><origin xyz='0 0 1'/><axis xyz='0 0 1'/>"
      "<limit lower='" +
      low + "' upper='" + high + "' effort='0' velocity='0'/></joint></robot>";
  const std::string sdf =
      "<sdf version='1.9'><world name='w'><model name='hull'><static>true</static>" +
      link_in_sdf("hull", 0.0) + "</model>\n<model name='leaf'>" + link_in_sdf("leaf", 1.0) +
      "<joint name='swing' type='" + (turns ? "revolute" : "prismatic") +
      "'><parent>world</parent><child>leaf</child><axis><xyz>0 0 1</xyz><limit><lower>" + low +
      "</lower><upper>" + high + "</upper></limit></axis></joint></model></world></sdf>";
  const std::string mjcf =
      "<mujoco>\n<compiler angle='radian'/><worldbody>\n"
      "<body name='hull' pos='0 0 0'><geom type='box' size='0.1 0.1 0.1'/></body>\n"
      "<body name='leaf' pos='0 0 1'><joint name='swing' type='" +
      std::string(turns ? "hinge" : "slide") + "' axis='0 0 1' limited='true' range='" + low + " " +
      high + "'/><geom type='box' size='0.1 0.1 0.1' mass='1'/></body></worldbody></mujoco>";
  return {{"urdf", &reads_urdf, urdf}, {"sdf", &reads_sdf, sdf}, {"mjcf", &reads_mjcf, mjcf}};
}

const JointSpec& swing(const WorldSpec& world) {
  const auto found = std::find_if(world.joints.begin(), world.joints.end(),
                                  [](const auto& one) { return one.name.ends_with("swing"); });
  REQUIRE(found != world.joints.end());
  return *found;
}

/// "2 of them: ...", of the only report, if there is one.
std::string only_report(const Workspace& workspace) {
  const auto all = workspace.reports();
  for (const auto& one : all) CAPTURE(one);
  REQUIRE(all.size() <= 1);
  if (all.empty()) return {};
  CHECK(all[0].starts_with("W5144 at "));
  return all[0].substr(all[0].find("taken over, ") + 12);
}

/// Loads it, which must do, whatever it warns of.
Scenario accepted(Workspace& workspace, const std::string& world) {
  auto scenario = workspace.load(scenario_with(world));
  for (const auto& one : workspace.reports()) CHECK_MESSAGE(one.front() == 'W', one);
  REQUIRE(scenario.has_value());
  return *std::move(scenario);
}

std::string world_of(const Format& format, const std::string& bodies = {},
                     const std::string& joints = {}) {
  return std::string("  ") + format.key + ": {file: world.file, at_m: [0, 0, 0.2]}\n" + kCup +
         (bodies.empty() ? "" : "    " + bodies + "\n") +
         (joints.empty() ? "" : "  joints:\n    " + joints + "\n");
}

TEST_CASE("a body or a joint of its own does not become one of the same name in an imported file") {
  for (const Format& format : with_joint(true, "-1", "1")) {
    if (!format.is_there()) continue;
    CAPTURE(format.key);
    const bool is_sdf = std::string_view(format.key) == "sdf";
    const std::string leaf = "leaf", joint = is_sdf ? "leaf_swing" : "swing";
    for (const std::string form :
         {"size_m: [1, 1, 1]", "sphere: {radius_m: 1}", "cylinder: {radius_m: 1, length_m: 1}",
          "capsule: {radius_m: 1, length_m: 1}", "mesh: none.stl",
          "hull: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]", "shapes: [{size_m: [1, 1, 1]}]",
          "ring: {diameter_m: 1, height_m: 1, wall_m: 0.1, sides: 8}"}) {
      CAPTURE(form);
      Workspace workspace;
      workspace.write("world.file", format.file);
      CHECK_FALSE(workspace.load(scenario_with(world_of(format, leaf + ": {" + form + "}"))));
      CHECK(workspace.sink.exit_code() == 3);
      REQUIRE(workspace.sink.error_count() == 1);
      CHECK(workspace.reports().back() ==
            "E5143 at 7:5: the file cannot be taken over: it has a body `leaf` too, and the body "
            "here is another, for it has `" +
                form.substr(0, form.find(':')) + "`");
      const auto found = workspace.sink.sorted().back();
      REQUIRE(found.notes.size() == 1);
      REQUIRE(found.notes[0].range.has_value());
      const auto& in = workspace.files[found.notes[0].range->file];
      CHECK(std::string_view(in.name()).ends_with("world.file"));
      CHECK(in.text().substr(found.notes[0].range->begin).find("'leaf'") < 20);
    }
    for (const std::string key : {"type: slider", "child: cup"}) {
      CAPTURE(key);
      Workspace workspace;
      workspace.write("world.file", format.file);
      CHECK_FALSE(workspace.load(scenario_with(world_of(format, "", joint + ": {" + key + "}"))));
      REQUIRE(workspace.sink.error_count() == 1);
      CHECK(workspace.reports().back() ==
            "E5143 at 8:5: the file cannot be taken over: it has a joint `" + joint +
                "` too, and the joint here is another, for it has `" +
                key.substr(0, key.find(':')) + "`");
    }
  }
}

TEST_CASE("an included robot does not become what an imported file calls as the robot does") {
  if (skips_mjcf()) return;
  Workspace workspace;
  workspace.write("robot.yaml", "bodies: {base: {size_m: [0.4, 0.4, 0.4], mass_kg: 9}}\n");
  workspace.write("room.yaml",
                  "mjcf: world.xml\nbodies:\n"
                  "  cup: {size_m: [0.1, 0.1, 0.1], mass_kg: 0.2, position_m: [5, 5, 0.05]}\n"
                  "  base: {material: wood}\n");
  workspace.write("world.xml",
                  bodies_with("<body name='base' pos='3 0 0'><geom size='1'/></body>"));
  CHECK_FALSE(workspace.load(scenario_with("  include: [robot.yaml, room.yaml]\n")).has_value());
  REQUIRE(workspace.sink.error_count() == 1);
  const auto found = workspace.sink.sorted().back();
  CHECK(found.message.ends_with(
      "it has a body `base` too, and the body here is another, for it has `size_m`"));
  REQUIRE(found.range.has_value());
  CHECK(std::string_view(workspace.files[found.range->file].name()).ends_with("robot.yaml"));
}

TEST_CASE("single keys are laid over what is imported") {
  for (const Format& format : with_joint(true, "-1", "1")) {
    if (!format.is_there()) continue;
    CAPTURE(format.key);
    const bool is_sdf = std::string_view(format.key) == "sdf";
    Workspace workspace;
    workspace.write("world.file", format.file);
    const std::string joint = is_sdf ? "leaf_swing" : "swing";
    const WorldSpec world =
        accepted(workspace,
                 world_of(format, "leaf: {material: wood, mass_kg: 2, kind: door, yaw_rad: 0.1}",
                          joint + ": {range_rad: [-0.5, 0.25], max_torque_nm: 3}"))
            .world;
    CHECK(body(world, "leaf").mass_kg == 2.0);
    CHECK(body(world, "leaf").material == "wood");
    CHECK((body(world, "leaf").shapes.front().size_m - Eigen::Vector3d::Constant(0.2)).norm() <
          1e-9);
    CHECK(swing(world).low_rad == -0.5);
    CHECK(swing(world).high_rad == 0.25);
    CHECK(swing(world).max_torque_nm == 3.0);
  }
}

TEST_CASE("a hinge has each of its stops within two turns, and no other in the place of one") {
  const std::string beyond = "1 of them: stops beyond 13 rad; the first is `";
  struct Stops {
    const char *low, *high;
    std::optional<double> low_rad, high_rad;
    std::string report;
  };
  for (const Stops& stops : std::vector<Stops>{{"-6", "0", -6.0, 0.0, ""},
                                               {"-1e16", "0.5", std::nullopt, 0.5, ""},
                                               {"-0.5", "1e300", -0.5, std::nullopt, ""},
                                               {"-6.28", "6.28", -6.28, 6.28, ""},
                                               {"-14", "4", std::nullopt, 4.0, beyond},
                                               {"-1e16", "90", std::nullopt, std::nullopt, beyond},
                                               {"-1e16", "1e16", std::nullopt, std::nullopt, ""},
                                               {"-3.1", "3.1", -3.1, 3.1, ""}}) {
    for (const Format& format : with_joint(true, stops.low, stops.high)) {
      if (!format.is_there()) continue;
      CAPTURE(format.key);
      CAPTURE(stops.low);
      CAPTURE(stops.high);
      Workspace workspace;
      workspace.write("world.file", format.file);
      const WorldSpec world = accepted(workspace, world_of(format)).world;
      CHECK(only_report(workspace).substr(0, stops.report.size()) == stops.report);
      CHECK(workspace.reports().empty() == stops.report.empty());
      CHECK(swing(world).low_rad == stops.low_rad);
      CHECK(swing(world).high_rad == stops.high_rad);
    }
  }
}

TEST_CASE("a slider with one stop has that one, and goes as far as it likes on the other side") {
  struct Stops {
    const char *low, *high;
    std::optional<double> low_m, high_m;
    bool is_said;
  };
  for (const Stops& stops : std::vector<Stops>{{"-0.1", "1e16", -0.1, std::nullopt, false},
                                               {"-1e16", "0.2", std::nullopt, 0.2, false},
                                               {"-0.1", "5000", -0.1, std::nullopt, true},
                                               {"-1e16", "1e16", std::nullopt, std::nullopt, false},
                                               {"-0.1", "0.2", -0.1, 0.2, false}}) {
    for (const Format& format : with_joint(false, stops.low, stops.high)) {
      if (!format.is_there()) continue;
      CAPTURE(format.key);
      CAPTURE(stops.low);
      CAPTURE(stops.high);
      Workspace workspace;
      workspace.write("world.file", format.file);
      const WorldSpec world = accepted(workspace, world_of(format)).world;
      CHECK(only_report(workspace).starts_with("1 of them: stops beyond 1000 m; the first is") ==
            stops.is_said);
      CHECK(workspace.reports().empty() != stops.is_said);
      CHECK(swing(world).low_m == stops.low_m);
      CHECK(swing(world).high_m == stops.high_m);
    }
  }
}

TEST_CASE("a slider with one stop halts there, and nowhere on the other side") {
  Workspace workspace;
  const std::string block =
      kCup + "    block: {size_m: [0.1, 0.1, 0.1], mass_kg: 1, position_m: [0, 0, 1]}\n";
  const auto with = [&](const std::string& range) {
    return block + "  joints: {rail: {child: block, axis: x, range_m: " + range +
           ", max_force_n: 50}}\n";
  };
  const WorldSpec spec = accepted(workspace, with("[-0.2, ~]")).world;
  for (const bool in_mujoco : {false, true}) {
    if (in_mujoco && !has_engine(EngineKind::kMujoco)) continue;
    CAPTURE(in_mujoco);
    for (const double sign : {-1.0, 1.0}) {
      WorldSpec stepped = spec;
      if (in_mujoco) stepped.engine = EngineKind::kMujoco;
      const auto world = make_world(stepped);
      REQUIRE_FALSE(world->reset(default_placements(world->layout()), 1).has_value());
      const SliderId rail = *world->layout().find_slider("rail");
      world->set_motor(rail, sign * 2.0, 50.0);
      places_after(*world, 2.0);
      const double at_m = world->slider_position_m(rail);
      if (sign < 0.0) {
        CHECK(std::abs(at_m + 0.2) < 0.01);
      } else {
        CHECK(at_m > 3.0);
      }
    }
  }
  for (const char* bad : {"[~]", "[0, x]", "[~, 1, 2]", "[~, ~]", "~", "[{}, ~]"}) {
    CAPTURE(bad);
    CHECK_FALSE(workspace.load(scenario_with(with(bad))).has_value());
    CHECK(workspace.sink.exit_code() == 3);
  }
}

TEST_CASE("a world takes over one file, and both places are named") {
  Workspace workspace;
  CHECK_FALSE(workspace.load(scenario_with("  mjcf: a.xml\n  sdf: b.sdf\n")).has_value());
  const auto found = workspace.sink.sorted();
  REQUIRE(found.size() == 1);
  CHECK(found[0].help.starts_with("A world takes over one file;"));
  REQUIRE(found[0].notes.size() == 1);
  REQUIRE(found[0].notes[0].range.has_value());
  const auto at =
      workspace.files[found[0].notes[0].range->file].position(found[0].notes[0].range->begin);
  CHECK(at.line == 5);
}

TEST_CASE("only a robot in URDF can be `fixed`, and nothing else is proposed") {
  for (const std::string key : {"sdf", "mjcf"}) {
    Workspace workspace;
    CHECK_FALSE(
        workspace.load(scenario_with("  " + key + ": {file: a.xml, fixed: true}\n")).has_value());
    const auto found = workspace.sink.sorted();
    REQUIRE(found.size() == 1);
    CHECK(workspace.reports()[0] == "E5102 at 4:" + std::to_string(key.size() + 19) +
                                        ": `fixed` is not a key of `" + key +
                                        "`: only a robot in URDF is held so");
    CHECK(found[0].fix.empty());
    CHECK(found[0].notes.empty());
    CHECK(found[0].help.starts_with("Remove it; in "));
    CHECK_FALSE(
        workspace.load(scenario_with("  " + key + ": {file: a.xml, fixd: true}\n")).has_value());
    REQUIRE(workspace.sink.sorted().size() == 1);
    REQUIRE(workspace.sink.sorted()[0].notes.size() == 1);
    CHECK(workspace.sink.sorted()[0].notes[0].text == "known keys: file, at_m, yaw_rad, positions");
  }
}

}  // namespace
}  // namespace parallax::harness::test
