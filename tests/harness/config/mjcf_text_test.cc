// Texts in MJCF: parts that are left out are reported, and impossible ones are refused at their
// place.

#include "tests/harness/config/mjcf_text.h"

#include <algorithm>

#include "harness/import/mesh.h"

namespace parallax::harness::test {
namespace {

/// "1 of them: sites; the first is `tip`", sorted; there is nothing else to report.
std::vector<std::string> kinds_left_out(const Workspace& workspace) {
  std::vector<std::string> kinds;
  for (const auto& one : workspace.reports()) {
    CHECK_MESSAGE(one.starts_with("W5144"), one);
    kinds.push_back(one.substr(one.find("not taken over, ") + 16));
  }
  std::sort(kinds.begin(), kinds.end());
  return kinds;
}

void check_kinds(const Workspace& workspace, const std::vector<std::string>& expected) {
  const auto kinds = kinds_left_out(workspace);
  for (std::size_t i = 0; i < std::min(kinds.size(), expected.size()); ++i) {
    CHECK(kinds[i] == expected[i]);
  }
  CHECK(kinds.size() == expected.size());
}

TEST_CASE("whatever a body of MJCF has that is not taken over is listed, by kind with the first") {
  if (skips_mjcf() || !reads_meshes()) return;
  Workspace workspace;
  const auto scenario = taken_over(workspace, file_with(R"(
<asset><hfield name="hill" nrow="3" ncol="3" size="1 1 1 1"/></asset>
<worldbody><light name="sun"/><camera name="eye"/>
  <geom name="slope" type="plane" size="0 0 1" zaxis="1 0 1"/>
  <geom name="ground" type="plane" size="0 0 1"/>
  <geom name="hills" type="hfield" hfield="hill" pos="20 0 0"/>
  <body name="led" mocap="true" pos="4 0 1"><geom name="lead" size="0.1"/></body>
  <body name="egg" pos="0 3 1"><freejoint/><geom name="egg_shell" type="ellipsoid" size="0.1 0.1 0.2"/>
    <geom name="paint" size="0.2" contype="0" conaffinity="0" mass="0"/></body>
  <body name="pole" pos="0 0 2"><joint name="swing" stiffness="2" armature="0.1"
      solreflimit="0.05 1"/>
    <geom name="rod" type="capsule" fromto="0 0 0 1 0 0" size="0.02" condim="1" margin="0.01"/>
    <site name="tip" pos="1 0 0"/>
    <body name="head" pos="1 0 0"><joint name="neck" type="ball"/>
      <geom name="skull" size="0.1" priority="1" condim="6" solref="0.05 1"/></body></body>
</worldbody>)"));
  check_kinds(workspace,
              {"1 of them: bodies that are led (mocap), which stand; the first is `led`",
               "1 of them: cameras; the first is `eye`",
               "1 of them: contacts without friction (condim 1); the first is `rod`",
               "1 of them: elements <hfield> of <asset>; the first is `hill`",
               "1 of them: friction against turning and rolling (condim); the first is `skull`",
               "1 of them: height fields; the first is `hills`",
               "1 of them: inertia of what drives joints (armature); the first is `swing`",
               "1 of them: joints of other types (held fast); the first is `neck`",
               "1 of them: lights; the first is `sun`",
               "1 of them: margins of contacts; the first is `rod`",
               "1 of them: planes that are not the floor; the first is `slope`",
               "1 of them: priorities of contacts; the first is `skull`",
               "1 of them: roundings of ellipsoids, which become hulls of 62 corners; the first is "
               "`egg_shell`",
               "1 of them: sites; the first is `tip`",
               "1 of them: softness of contacts (solref, solimp); the first is `skull`",
               "1 of them: softness of joints (solref, solimp); the first is `swing`",
               "1 of them: springs of joints; the first is `swing`",
               "1 of them: visuals; the first is `paint`"});
  REQUIRE(scenario.has_value());
  const WorldSpec& world = scenario->world;
  CHECK(joint(world, "neck").type == JointType::kFixed);
  CHECK(body(world, "led").mass_kg == 0.0);
  const BodyShape& egg = body(world, "egg").shapes.front();
  CHECK((egg.size_m - Eigen::Vector3d(0.2, 0.2, 0.4)).norm() < 1e-9);
  REQUIRE(egg.hull != nullptr);
  for (int i = 0; i < 2000; ++i) {  // 7 % of the radius is the most that it loses
    const double z = 1.0 - (2.0 * i + 1.0) / 2000.0, r = std::sqrt(1.0 - z * z), turn = 2.4 * i;
    const Eigen::Vector3d p(0.1 * r * std::cos(turn), 0.1 * r * std::sin(turn), 0.2 * z);
    CHECK(egg.hull->depth_of(0.93 * p) >= 0.0);
    CHECK(egg.hull->depth_of(1.0001 * p) <= 0.0);
  }
}

TEST_CASE("so is what a file in MJCF has besides bodies") {
  if (skips_mjcf()) return;
  Workspace workspace;
  const auto scenario = taken_over(workspace, file_with(R"(
<option density="1.2"><flag passive="disable"/></option>
<custom><numeric name="n" data="1"/><text name="t" data="x"/></custom>
<asset><material name="red"/><texture name="pic" type="2d" file="/nowhere/pic.png"/></asset>
<worldbody>
  <body name="egg" pos="0 3 1"><freejoint/><geom name="shell" size="0.1"/></body>
  <body name="cart" pos="0 -3 1"><joint name="rail" type="slide"/>
    <geom name="load" size="0.1" mass="1"/></body>
</worldbody>
<contact><pair name="own" geom1="load" geom2="shell"/></contact>
<equality><weld name="glue" body1="egg" body2="cart"/></equality>
<tendon><fixed name="rope"><joint joint="rail" coef="1"/></fixed></tendon>
<actuator><motor name="drive" joint="rail"/></actuator>
<sensor><jointpos name="feeler" joint="rail"/><jointvel joint="rail"/></sensor>
<keyframe><key name="home"/></keyframe>)"));
  CHECK(scenario.has_value());
  check_kinds(
      workspace,
      {"1 of them: actuators; the first is `drive`",
       "1 of them: equality constraints; the first is `glue`",
       "1 of them: forces of air and water (density, viscosity, wind); the first is `option`",
       "1 of them: keyframes; the first is `home`", "1 of them: materials; the first is `red`",
       "1 of them: pairs of geoms with a contact of their own; the first is `own`",
       "1 of them: parts of the engine that are switched off; the first is `passive`",
       "1 of them: pictures (textures); the first is `pic`",
       "1 of them: tendons; the first is `rope`",
       "2 of them: data of the file's own (custom); the first is `n`",
       "2 of them: sensors; the first is `feeler`"});
}

TEST_CASE("settings of the engine that are not the usual ones are listed, at the options") {
  if (skips_mjcf()) return;
  const auto said = [](const std::string& option) {
    Workspace workspace;
    CHECK(taken_over(workspace, file_with("\n<option " + option + "/>\n<worldbody>" +
                                          box_at(0, "box") + "</worldbody>"))
              .has_value());
    const auto all = workspace.reports();
    REQUIRE(all.size() <= 1);
    return all.empty() ? std::string() : all.front();
  };
  CHECK(said("timestep='0.002' integrator='Euler' cone='pyramidal' impratio='1' solver='Newton' "
             "iterations='100' tolerance='1e-8' noslip_iterations='0' collision='all'")
            .empty());
  const std::string settings = "settings of MuJoCo's engine (option); the first is `";
  for (const char* one :
       {"timestep='0.01'", "integrator='RK4'", "cone='elliptic'", "impratio='5'", "solver='CG'",
        "iterations='7'", "tolerance='1e-4'", "noslip_iterations='3'"}) {
    const std::string text = one;
    CHECK(said(text) == "W5144 at 3:1: not taken over, 1 of them: " + settings +
                            text.substr(0, text.find('=')) + "`");
  }
  CHECK(said("cone='elliptic' timestep='0.01'") ==
        "W5144 at 3:1: not taken over, 2 of them: " + settings + "timestep`");
  CHECK(said("collision='predefined'") ==
        "W5144 at 3:1: not taken over, 1 of them: the choice of which contacts there are "
        "(collision); the first is `option`");
}

TEST_CASE("a body that is led is told at its own place") {
  if (skips_mjcf()) return;
  Workspace workspace;
  CHECK(taken_over(workspace, bodies_with(box_at(0, "one") + "\n" +
                                          "<body name='two' pos='3 0 1'><geom size='0.1'/></body>\n"
                                          "<body name='led' pos='4 0 1' mocap='true'><geom "
                                          "size='0.1'/></body>\n<body name='also' pos='5 0 1' "
                                          "mocap='true'><geom size='0.1'/></body>"))
            .has_value());
  CHECK(workspace.reports() ==
        std::vector<std::string>{"W5144 at 5:1: not taken over, 2 of them: bodies that are led "
                                 "(mocap), which stand; the first is `led`"});
}

TEST_CASE(
    "nothing collides where MuJoCo's contacts are off, and a plane beside 0 becomes the floor") {
  if (skips_mjcf()) return;
  Workspace workspace;
  const std::string both = "<worldbody><geom name='mark' size='0.1' pos='0 0 1'/>" +
                           box_at(0, "a", "") + box_at(0, "b", "") + "</worldbody>";
  auto scenario =
      taken_over(workspace, file_with("<option><flag contact='disable'/></option>" + both));
  REQUIRE(scenario.has_value());
  const auto layout = lay_out(scenario->world);
  const auto at = [&](const char* name) { return *layout.find_body(name); };
  CHECK(layout.never_collide(at("a"), at("b")));
  CHECK(layout.never_collide(at("a"), at("mark")));

  const auto with_plane = [&](const std::string& planes) {
    return file_with("<worldbody>" + planes + box_at(0, "a", "") + "</worldbody>");
  };
  const std::string low = "<geom type='plane' size='1 1 1' pos='0 0 -0.25'/>",
                    lower = "<geom type='plane' size='1 1 1' pos='0 0 -2'/>",
                    level = "<geom type='plane' size='1 1 1'/>";
  scenario = taken_over(workspace, with_plane(level + low));
  REQUIRE(scenario.has_value());
  const double before = body(scenario->world, "a").p_WB.z();
  scenario = taken_over(workspace, with_plane(lower + low));
  REQUIRE(scenario.has_value());
  CHECK(body(scenario->world, "a").p_WB.z() == doctest::Approx(before + 0.25));
  const auto reports = workspace.reports();
  CHECK(std::any_of(reports.begin(), reports.end(), [](const std::string& one) {
    return one.find("heights of a floor that is not at 0") != one.npos;
  }));
}

TEST_CASE("what MuJoCo keeps apart is kept apart, and said where it cannot be") {
  if (skips_mjcf()) return;
  const auto free = [](double x, const std::string& name, const char* bits) {
    return box_at(x, name, std::string(" ") + bits);
  };
  const std::string one = "contype='1' conaffinity='1'", none = "contype='2' conaffinity='4'";
  Workspace workspace;
  // a and b are excluded; p and q have no bit in common with each other, nor with anything else.
  auto scenario = taken_over(
      workspace, file_with("<worldbody>" + free(0, "a", one.c_str()) + free(1, "b", one.c_str()) +
                           free(2, "c", one.c_str()) +
                           "</worldbody><contact><exclude body1='a' body2='b'/></contact>"));
  REQUIRE(scenario.has_value());
  CHECK(workspace.reports().empty());
  CHECK(body(scenario->world, "a").apart == "apart_of_a");
  CHECK(body(scenario->world, "b").apart == "apart_of_a");
  CHECK(body(scenario->world, "c").apart.empty());

  scenario = taken_over(workspace, file_with("<worldbody>" + free(0, "a", one.c_str()) +
                                             free(1, "b", one.c_str()) + free(2, "c", one.c_str()) +
                                             "</worldbody><contact><exclude body1='a' body2='b'/>"
                                             "<exclude body1='b' body2='c'/></contact>"));
  REQUIRE(scenario.has_value());  // a and c do collide, so each pair has a word of its own
  CHECK(workspace.reports().empty());
  CHECK(body(scenario->world, "a").apart == "a_without_b");
  CHECK(body(scenario->world, "b").apart == "a_without_b b_without_c");
  CHECK(body(scenario->world, "c").apart == "b_without_c");
  const auto layout = lay_out(scenario->world);
  const auto at = [&](const char* name) { return *layout.find_body(name); };
  CHECK(layout.never_collide(at("a"), at("b")));
  CHECK(layout.never_collide(at("c"), at("b")));
  CHECK_FALSE(layout.never_collide(at("a"), at("c")));

  scenario = taken_over(
      workspace, file_with("<worldbody>" + free(0, "p", none.c_str()) + free(1, "q", none.c_str()) +
                           "<geom type='plane' size='0 0 1' contype='1'/></worldbody>"));
  REQUIRE(scenario.has_value());
  CHECK(body(scenario->world, "p").apart == "apart_of_p");
  CHECK(
      workspace.reports() ==
      std::vector<std::string>{
          "W5144 at 2:12: not taken over, 2 of them: pairs of bodies that are kept apart (contype, "
          "conaffinity, exclude); the first is `p and the floor`"});

  const std::string chain =
      "<worldbody><body name='u' pos='0 0 1'><joint/><geom size='0.1'/><body name='v' pos='0.1 0 "
      "0'><joint/><geom size='0.1'/><body name='w' pos='0.1 0 0'><joint/><geom size='0.1'/></body>"
      "</body></body></worldbody>";
  scenario = taken_over(workspace, file_with(chain));
  REQUIRE(scenario.has_value());
  CHECK(
      workspace.reports() ==
      std::vector<std::string>{"W5144 at 2:12: not taken over, 1 of them: collisions of parts that "
                               "hang together by joints; the first is `u and w`"});
  scenario =
      taken_over(workspace, file_with(chain + "<contact><exclude body1='u' body2='w'/></contact>"));
  CHECK(workspace.reports().empty());
}

TEST_CASE("MJCF that cannot be is refused in one line, at its place") {
  if (skips_mjcf()) return;
  const std::string at_3 = "E5143 at 3:1: the file cannot be taken over: ";
  const auto joint_with = [](const std::string& attributes) {
    return bodies_with("<body name='b' pos='0 0 1'><joint name='j' " + attributes +
                       "/><geom size='0.1'/></body>");
  };
  std::string many_bodies, many_elements, deep;
  for (int i = 0; i < 1001; ++i) many_bodies += "<body/>";
  for (int i = 0; i < 1'000'000; ++i) many_elements += "<a/>";
  for (int i = 0; i < 100'000; ++i) deep += "<body>";
  for (const BadText& one : std::vector<BadText>{
           {"", "E5143 at 1:1: the file cannot be taken over: there is no XML element"},
           {"<!DOCTYPE m [<!ENTITY a 'aa'><!ENTITY b '&a;&a;'>]><mujoco/>",
            "E5143 at 1:1: the file cannot be taken over: document types"},
           {"<mujoco><![CDATA[x]]></mujoco>", "E5143 at 1:9: the file cannot be taken over: CDATA"},
           {"<robot name='r'><link name='l'/></robot>",
            "E5143 at 1:1: the file cannot be taken over: the outermost element is no <mujoco>"},
           {"<mujoco>" + deep, "E5143 at 1:387: the file cannot be taken over: elements nest"},
           {"<mujoco>" + many_elements + "</mujoco>",
            "E5143 at 1:120005: the file cannot be taken over: there are more than 30000 elements"},
           {bodies_with(many_bodies), "E5143 at 1:1: the file cannot be taken over: all comes to"},
           {"<mujoco><a\v b='1'/></mujoco>",
            "E5143 at 1:11: the file cannot be taken over: holds a control character"},
           {"<mujoco><m:esh file='x'/></mujoco>",
            "E5143 at 1:9: the file cannot be taken over: `m:esh` is no name of MJCF"},
           {bodies_with("<geom type='cone' size='1'/>"), at_3 + "invalid keyword: 'cone'"},
           {bodies_with("<geom bogus='1'/>"), at_3 + "Schema violation: unrecognized attribute"},
           {bodies_with("<geom size='0'/>"), at_3 + "sizes must be positive"},
           {bodies_with("<geom size='nan'/>"), "E5"},
           {bodies_with("<geom type='box' size='1 inf 1'/>"), at_3 + "something of the geom"},
           {bodies_with("<geom size='1e400'/>"), at_3 + "problem reading attribute 'size'"},
           {bodies_with("<geom size='1e30'/>"), "E5"},
           {bodies_with("<body name='b'><freejoint/></body>"), at_3 + "mass and inertia of moving"},
           {bodies_with("<body><freejoint/><geom size='1' mass='-1'/></body>"),
            "E5143 at 3:19: the file cannot be taken over: mass, inertia or density are negative"},
           {bodies_with("<body><freejoint/><geom size='0.1' mass='1e300'/></body>"), "E5"},
           {bodies_with("<body><inertial pos='0 0 0' mass='1' diaginertia='1 1 9'/><joint/><geom "
                        "size='1'/></body>"),
            at_3 + "inertia must satisfy A + B >= C"},
           {bodies_with("<body name='b'><freejoint/><inertial pos='0 0 inf' mass='1' "
                        "diaginertia='1 1 1'/></body>"),
            "E5"},
           {joint_with("range='2 1' limited='true'"),
            "E5143 at 3:28: the file cannot be taken over: range[0] should be smaller"},
           {joint_with("damping='-1'"), "E5"},
           {bodies_with(
                "<body name='h'><geom size='1'/></body><body name='h'><geom size='1'/></body>"),
            "E5143 at 3:1: the file cannot be taken over: repeated name"},
           {file_with("<option gravity='1 0 -9'/>"),
            "E5143 at 2:1: the file cannot be taken over: gravity does not point along z"},
           {bodies_with("<composite type='grid' count='1000 1000 1000' spacing='1'><geom "
                        "size='1'/></composite>"),
            at_3 + "things of many small parts"},
           {file_with("<size nuser_body='2000000000'/><worldbody><geom size='1'/></worldbody>"),
            "E5143 at 1:1: the file cannot be taken over: it asks for too much memory"},
           {file_with("<keyframe><key name='a' qpos='1 2 3'/></keyframe>"),
            "E5143 at 1:1: the file cannot be taken over: MuJoCo does not say where: key 0:"},
           {file_with("<plugin/>"),
            "E5143 at 2:1: the file cannot be taken over: Schema violation: unrecognized element"},
       }) {
    CAPTURE(one.text.substr(0, 300));
    Workspace workspace;
    const auto said = refusal_of(workspace, one.text);
    CHECK(said.substr(0, one.report.size()) == one.report);
    CHECK(said.find('\n') == said.npos);
    CHECK_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
    CHECK_FALSE(std::filesystem::exists(workspace.folder() / "MUJOCO_LOG.TXT"));
  }
}

TEST_CASE("a program that was built without MuJoCo says so") {
  if (reads_mjcf()) return;
  Workspace workspace;
  CHECK_FALSE(taken_over(workspace, bodies_with("")).has_value());
  CHECK(workspace.reports().front() ==
        "E5142 at 4:3: `mjcf` cannot be read: this program was built without libmujoco-dev");
}

}  // namespace
}  // namespace parallax::harness::test
