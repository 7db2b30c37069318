// Files in MJCF of strangers: what is left out is said, what cannot be is refused at its place, and
// nothing is opened that is not vetted.

#include <sys/stat.h>

#include <iostream>

#include "harness/import/import.h"
#include "harness/import/mesh.h"
#include "tests/harness/config/imported_world.h"

namespace parallax::harness::test {
namespace {

const std::string kMjcf = "  mjcf: world.xml\n  models: models\n" + kCup;

bool skips_mjcf() {
  if (reads_mjcf()) return false;
  std::cout << "SKIPPED: this build reads no MJCF\n";
  return true;
}

/// A world with this on its third line.
std::string bodies_with(const std::string& inside) {
  return "<mujoco>\n<worldbody>\n" + inside + "\n</worldbody>\n</mujoco>";
}

/// With these sections from its second line on.
std::string file_with(const std::string& sections) {
  return "<mujoco>\n" + sections + "\n</mujoco>";
}

std::string box_at(double x, const std::string& name, const std::string& more = {}) {
  return "<body name='" + name + "' pos='" + std::to_string(x) +
         " 0 0.1'><freejoint/><geom type='box' size='0.1 0.1 0.1' mass='1'" + more + "/></body>";
}

/// A tetrahedron in OBJ.
constexpr const char* kTetrahedron =
    "v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nv 0 0 0.2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

std::optional<Scenario> taken_over(Workspace& workspace, const std::string& text) {
  std::filesystem::create_directories(workspace.folder() / "models");
  workspace.write("world.xml", text);
  return workspace.load(scenario_with(kMjcf));
}

struct BadText {
  std::string text, report;  // how the report begins
};

/// The first report, which must be the only error of a file that is refused.
std::string refusal_of(Workspace& workspace, const std::string& text) {
  CHECK_FALSE(taken_over(workspace, text).has_value());
  CHECK(workspace.sink.exit_code() == 3);
  for (const std::string& one : workspace.reports()) {
    if (one.front() == 'E') return one;
  }
  return {};
}

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
       "1 of them: forces of air and water (density, viscosity); the first is `option`",
       "1 of them: keyframes; the first is `home`", "1 of them: materials; the first is `red`",
       "1 of them: pairs of geoms with a contact of their own; the first is `own`",
       "1 of them: parts of the engine that are switched off; the first is `passive`",
       "1 of them: pictures (textures); the first is `pic`",
       "1 of them: tendons; the first is `rope`",
       "2 of them: data of the file's own (custom); the first is `n`",
       "2 of them: sensors; the first is `feeler`"});
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
  REQUIRE(scenario.has_value());  // a and c do collide, so no word can say it
  CHECK(
      workspace.reports() ==
      std::vector<std::string>{
          "W5144 at 2:12: not taken over, 2 of them: pairs of bodies that are kept apart (contype, "
          "conaffinity, exclude); the first is `a and b`"});
  CHECK(body(scenario->world, "b").apart.empty());

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

TEST_CASE("includes and meshes lie beside the file or in a folder of models, by plain names") {
  if (skips_mjcf() || !reads_meshes()) return;
  Workspace workspace;
  std::filesystem::create_directories(workspace.folder() / "parts/deep");
  std::filesystem::create_directories(workspace.folder() / "models/shared");
  workspace.write("parts/box.xml", "<mujocoinclude>\n" + box_at(0, "one") +
                                       "\n<include file='parts/deep/more.xml'/></mujocoinclude>");
  workspace.write("parts/deep/more.xml", "<x>" + box_at(1, "two") + "</x>");
  workspace.write("models/shared/three.xml", "<x>" + box_at(2, "three") + "</x>");
  workspace.write("parts/deep/thing.obj", kTetrahedron);
  workspace.write("parts/thing.obj",
                  "v 0 0 0\nv 0.4 0 0\nv 0 0.4 0\nv 0 0 0.4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  // Two files of one name, one of which goes by that name.
  const auto scenario = taken_over(workspace, file_with(R"(
<compiler meshdir="./parts/"/>
<asset><mesh file="thing.obj"/><mesh name="other" file='deep/thing.obj'/></asset>
<worldbody>
<include file="parts/box.xml"/><include file="./shared/three.xml"/>
<body name="large" pos="4 0 1"><freejoint/><geom type="mesh" mesh="thing" mass="1"/></body>
<body name="small" pos="5 0 1"><freejoint/><geom type="mesh" mesh="other" mass="1"/></body>
</worldbody>)"));
  CHECK(workspace.reports().empty());
  REQUIRE(scenario.has_value());
  for (const char* name : {"one", "two", "three"})
    CHECK(body(scenario->world, name).mass_kg == 1.0);
  const auto extent = [&](const char* name) {
    const BodyShape& shape = body(scenario->world, name).shapes.front();
    REQUIRE(shape.hull != nullptr);
    double most = 0.0;
    for (const auto& a : shape.hull->vertices) {
      for (const auto& b : shape.hull->vertices) most = std::max(most, (a - b).norm());
    }
    return most;
  };
  CHECK(extent("large") == doctest::Approx(0.4 * std::sqrt(2.0)));
  CHECK(extent("small") == doctest::Approx(0.2 * std::sqrt(2.0)));
  const auto read = workspace.files.inputs();
  for (const char* name : {"parts/box.xml", "models/shared/three.xml", "parts/deep/thing.obj"}) {
    const auto real = std::filesystem::canonical(workspace.folder() / name).string();
    CHECK_MESSAGE(std::any_of(read.begin(), read.end(),
                              [&](const auto& one) {
                                return std::filesystem::path(one).lexically_normal() == real;
                              }),
                  name);
  }
}

TEST_CASE("pictures, skins and height fields are not opened, wherever they are said to be") {
  if (skips_mjcf()) return;
  Workspace workspace;
  REQUIRE(::mkfifo((workspace.folder() / "pipe.png").c_str(), 0600) == 0);  // opened, it waits
  const auto scenario = taken_over(workspace, file_with(R"(
<asset><texture file="pipe.png" type="2d"/><texture name="huge" type="2d" builtin="flat"
  width="1000000" height="1000000"/><texture name="sky" type="cube" fileup="/dev/zero"/>
<material name="m" texture="pipe"/><skin name="s" file="../../pipe.png"><bone/></skin>
<hfield name="h" size="1 1 1 1" nrow="100000" ncol="100000"/><hfield name="k" file="/dev/zero"
  size="1 1 1 1"/></asset>
<worldbody><geom type="hfield" hfield="k"/><geom type="hfield" hfield="h"/>)" +
                                                        box_at(0, "box") + "</worldbody>"));
  CHECK(scenario.has_value());
  const auto reports = workspace.reports();
  REQUIRE(reports.size() == 4);
  for (const char* kind : {"3 of them: pictures (textures); the first is `pipe.png`",
                           "1 of them: skins; the first is `s`", "2 of them: height fields"}) {
    CHECK_MESSAGE(std::any_of(reports.begin(), reports.end(),
                              [&](const auto& one) { return one.find(kind) != one.npos; }),
                  kind);
  }
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
           {joint_with("range='10 20' limited='true'"), "E51"},
           {joint_with("damping='-1'"), "E5"},
           {bodies_with("<body name='b'><joint name='x'/><joint name='y' type='slide'/><geom "
                        "size='1'/></body>"),
            "E5143 at 3:33: the file cannot be taken over: the body `b` has 2 joints"},
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

TEST_CASE("files that MJCF names where none may be are refused, and includes that do not end") {
  if (skips_mjcf()) return;
  const auto include = [](const std::string& file) {
    return bodies_with("<include file='" + file + "'/>");
  };
  const auto mesh = [](const std::string& file, const std::string& more = {}) {
    return "<mujoco>\n" + more + "<asset>\n<mesh file='" + file + "'/></asset></mujoco>";
  };
  const std::string at_3 = "E5143 at 3:1: the file cannot be taken over: ";
  for (const BadText& one : std::vector<BadText>{
           {include("none.xml"), at_3 + "`none.xml` is neither beside the description nor"},
           {include("/etc/passwd"), at_3 + "`/etc/passwd` is not read"},
           {include("../out.xml"), at_3 + "`../out.xml` is not read"},
           {include("parts/../../out.xml"), at_3 + "`parts/../../out.xml` is not read"},
           {include("&#46;&#46;/out.xml"), at_3 + "`&#46;&#46;/out.xml` is not read"},
           {include(".hidden.xml"), at_3 + "`.hidden.xml` is not read"},
           {include("linked.xml"), at_3 + "`linked.xml` leads through a link"},
           {include("way/out.xml"), at_3 + "`way/out.xml` leads through a link"},
           {include("models"), at_3 + "there is no regular file `models`"},
           {include("pipe.xml"), at_3 + "there is no regular file `pipe.xml`"},
           {include("ring.xml"),
            at_3 + "in `ring.xml`: `ring.xml` is included a second time, or includes itself"},
           {include("left.xml"),
            at_3 + "in `right.xml`: `left.xml` is included a second time, or includes itself"},
           {include("bomb.xml"), at_3 + "in `bomb.xml`: document types"},
           {include("deep.xml"), at_3 + "in `deep.xml`: elements nest"},
           {include("bad.xml"), at_3 + "in `bad.xml`, line 3: invalid keyword: 'cone'"},
           {include("robot.xml"), at_3},
           {bodies_with("<include/>"), at_3 + "an <include> names no file"},
           {mesh("none.stl"), at_3 + "`none.stl` is neither"},
           {mesh("/etc/passwd.stl"), at_3 + "`/etc/passwd.stl` is not read"},
           {mesh("x.obj", "<compiler meshdir='..'/>"), at_3 + "`../x.obj` is not read"},
           {mesh("x.obj", "<compiler meshdir='/tmp'/>"), at_3 + "`/tmp/x.obj` is not read"},
           {mesh("linked.obj"), at_3 + "`linked.obj` leads through a link"},
           {mesh("text.stl"), at_3},
           {mesh("text.dae"), "E5143 at "},
           {"<mujoco>\n<asset><mesh name='f' file='flat.obj'/></asset>\n<worldbody><geom "
            "type='mesh' mesh='f'/></worldbody></mujoco>",
            "E5143 at 2:1: the file cannot be taken over: qhull error (`f`)"},
           {mesh("wild.obj"),
            "E5143 at 1:1: the file cannot be taken over: MuJoCo's reader crashed on it"},
           {mesh("noformat"), at_3 + "`noformat` has no format"},
           {"<mujoco>\n<worldbody>\n<geom file='x.stl'/></worldbody></mujoco>",
            at_3 + "a <geom> names a file"},
       }) {
    CAPTURE(one.text);
    Workspace workspace;
    const auto folder = workspace.folder();
    std::filesystem::create_directories(folder / "parts");
    workspace.write("ring.xml", "<x><include file='ring.xml'/></x>");
    workspace.write("left.xml", "<x><include file='right.xml'/></x>");
    workspace.write("right.xml", "<x><include file='left.xml'/></x>");
    workspace.write("bomb.xml", "<!DOCTYPE x [<!ENTITY a 'aaaa'>]><x>&a;</x>");
    std::string deep = "<x>";
    for (int i = 0; i < 1000; ++i) deep += "<body>";
    workspace.write("deep.xml", deep);
    workspace.write("bad.xml", "<x>\n<body/>\n<geom type='cone'/></x>");
    workspace.write("robot.xml", "<robot name='r'><link name='l'/></robot>");
    workspace.write("text.stl", "this is no mesh");
    workspace.write("text.dae", "<COLLADA/>");
    workspace.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
    workspace.write("wild.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 999999999\nf -9 1 2\n");
    workspace.write("noformat", kTetrahedron);
    workspace.write("x.obj", kTetrahedron);
    workspace.write(".hidden.xml", "<x/>");
    std::filesystem::create_symlink("/etc/passwd", folder / "linked.xml");
    std::filesystem::create_symlink(folder / "x.obj", folder / "linked.obj");
    std::filesystem::create_directory_symlink("/etc", folder / "way");
    REQUIRE(::mkfifo((folder / "pipe.xml").c_str(), 0600) == 0);
    const auto said = refusal_of(workspace, one.text);
    CHECK(said.substr(0, one.report.size()) == one.report);
    CHECK(said.find('\n') == said.npos);
  }
}

TEST_CASE("a file that lies beside the description, but where no file may be named, is not read") {
  if (skips_mjcf()) return;
  const Workspace workspace;
  workspace.write("box.xml", "<x>" + box_at(0, "box") + "</x>");
  ImportInput input;
  input.text = bodies_with("<include file='box.xml'/>");
  input.folder = workspace.folder();
  CHECK_FALSE(import_mjcf(input).fault.has_value());
  input.admits = [](const std::filesystem::path& path) { return path.filename() != "box.xml"; };
  const auto made = import_mjcf(input);
  REQUIRE(made.fault.has_value());
  CHECK(made.fault->message == "`box.xml` lies where no file may be named");
  CHECK(made.files.empty());
}

TEST_CASE("a mesh of a million faces is refused, as one that is too long is") {
  if (skips_mjcf()) return;
  Workspace workspace;
  std::string wavy;  // a grid of 710 x 710 corners, so of a million triangles
  constexpr int kSide = 710;
  for (int i = 0; i < kSide * kSide; ++i) {
    wavy += "v " + std::to_string(i % kSide) + " " + std::to_string(i / kSide) + " " +
            std::to_string(i % 7) + "\n";
  }
  for (int i = 0; i + kSide + 1 < kSide * kSide; ++i) {
    const auto n = [](int k) { return std::to_string(k + 1); };
    if (i % kSide == kSide - 1) continue;
    wavy += "f " + n(i) + " " + n(i + 1) + " " + n(i + kSide) + "\nf " + n(i + 1) + " " +
            n(i + kSide + 1) + " " + n(i + kSide) + "\n";
  }
  REQUIRE(wavy.size() < kMaxMeshBytes);
  workspace.write("wavy.obj", wavy);
  workspace.write("long.stl", std::string(kMaxMeshBytes + 1, ' '));
  const auto with = [](const std::string& file) {
    return "<mujoco>\n<asset><mesh name='m' file='" + file +
           "'/></asset>\n<worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>";
  };
  CHECK(refusal_of(workspace, with("wavy.obj")).starts_with("E5143 at "));
  CHECK(refusal_of(workspace, with("long.stl")) ==
        "E5143 at 2:8: the file cannot be taken over: `long.stl` is too long");
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
