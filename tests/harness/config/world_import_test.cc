// Worlds and robots in other formats, from their files to bodies that stand still.

#include <algorithm>
#include <numbers>
#include <sstream>

#include "harness/engine/ode_world.h"
#include "harness/import/import.h"
#include "harness/import/mesh.h"
#include "tests/harness/config/imported_world.h"

namespace parallax::harness::test {
namespace {

struct Loaded {
  explicit Loaded(const std::string& world) { scenario = workspace.load(scenario_with(world)); }
  Workspace workspace;
  std::optional<Scenario> scenario;
  std::string first() const {
    const auto all = workspace.reports();
    return all.empty() ? std::string() : all.front();
  }
};

/// Puts `text` into a file, before the first `mark`.
void insert_before(const std::filesystem::path& path, const std::string& mark,
                   const std::string& text) {
  std::ostringstream all;
  all << std::ifstream(path).rdbuf();
  std::string content = all.str();
  const auto at = content.find(mark);
  REQUIRE(at != std::string::npos);
  std::ofstream(path) << content.insert(at, text);
}

TEST_CASE("where a model was looked for in vain is an input, too") {
  if (!reads_sdf()) return;
  Workspace workspace;
  file_in_scenarios(workspace, "worlds/office.sdf");
  file_in_scenarios(workspace, "worlds/models");
  std::filesystem::create_directory(workspace.folder() / "near");
  const auto loaded = workspace.load(scenario_with(
      "  sdf: office.sdf\n  models: [near, models]\n"
      "  bodies: {mug1: {settable: [x, y]}, cup: {size_m: [0.1, 0.1, 0.1], mass_kg: 0.2, "
      "position_m: [5, 5, 0.05]}}\n"));
  REQUIRE(loaded.has_value());
  const auto inputs = workspace.files.inputs();
  const auto near = std::filesystem::canonical(workspace.folder() / "near") / "mug";
  CHECK(std::count(inputs.begin(), inputs.end(), near.string()) > 0);
}

TEST_CASE("packages lie in folders of other names, whatever kind of address names them") {
  const std::string model =
      "<sdf version='1.9'><model name='shelf'><link name='l'><inertial><mass>2</mass></inertial>"
      "<collision name='c'><geometry><box><size>0.1 0.2 0.3</size></box></geometry></collision>"
      "</link></model></sdf>";
  const auto fill = [&](Workspace& workspace) {
    std::filesystem::create_directories(workspace.folder() / "parts/mine/meshes");
    workspace.write("parts/mine/model.config",
                    "<model><name>shelf</name><sdf version='1.9'>model.sdf</sdf></model>");
    workspace.write("parts/mine/model.sdf", model);
    workspace.write("parts/mine/meshes/wedge.obj",
                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  };
  const auto world = [](const std::string& uri) {
    return "<sdf version='1.9'><world name='w'><include><uri>" + uri +
           "</uri><pose>0 0 1 0 0 0</pose></include></world></sdf>";
  };
  const std::string packages = "  packages: {shelf: parts/mine}\n";
  for (const char* uri : {"model://shelf", "package://shelf", "package://shelf/model.sdf",
                          "https://fuel.gazebosim.org/1.0/someone/models/shelf",
                          "https://fuel.gazebosim.org/1.0/someone/models/shelf/3",
                          "https://fuel.ignitionrobotics.org/1.0/a/models/shelf/tip"}) {
    if (!reads_sdf()) continue;
    CAPTURE(uri);
    Workspace workspace;
    fill(workspace);
    workspace.write("world.sdf", world(uri));
    const auto loaded = workspace.load(scenario_with("  sdf: world.sdf\n" + packages + kCup));
    REQUIRE(loaded.has_value());
    CHECK(body(loaded->world, "shelf").mass_kg == 2.0);
  }
  for (const char* uri :
       {"model://none", "model://../shelf", "package://..", "package:///mine",
        "https://fuel.gazebosim.org/1.0/someone/worlds/shelf",
        "https://fuel.gazebosim.org/1.0/someone/models/shelf/../../x", "file://parts/mine"}) {
    if (!reads_sdf()) continue;
    CAPTURE(uri);
    Workspace workspace;
    fill(workspace);
    workspace.write("world.sdf", world(uri));
    CHECK_FALSE(workspace.load(scenario_with("  sdf: world.sdf\n" + packages + kCup)).has_value());
    CHECK(workspace.reports().front().starts_with("E5143 at 1:45"));
  }
  for (const auto& [mesh, is_there] : std::vector<std::pair<std::string, bool>>{
           {"package://shelf/meshes/wedge.obj", true},
           {"https://fuel.gazebosim.org/1.0/a/models/shelf/2/files/meshes/wedge.obj", true},
           {"package://shelf/../mine/meshes/wedge.obj", true},
           {"package://../parts/mine/meshes/wedge.obj", false},
           {"package://other/meshes/wedge.obj", false}}) {
    if (!reads_urdf() || !reads_meshes()) continue;
    CAPTURE(mesh);
    Workspace workspace;
    fill(workspace);
    workspace.write("robot.urdf",
                    "<robot name='r'><link name='a'><inertial><mass value='1'/><inertia ixx='1' "
                    "iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial><collision><geometry>"
                    "<mesh filename='" +
                        mesh + "'/></geometry></collision></link></robot>");
    const auto loaded = workspace.load(
        scenario_with("  urdf: {file: robot.urdf, at_m: [0, 0, 2]}\n" + packages + kCup));
    REQUIRE(loaded.has_value());
    CHECK((body(loaded->world, "a").shapes.front().form == ShapeForm::kHull) == is_there);
  }
}

TEST_CASE("an office in SDF: includes, frames, a door on its hinge, and what is left out is said") {
  if (!reads_sdf()) return;
  Workspace workspace;
  file_in_scenarios(workspace, "worlds/office.sdf");
  file_in_scenarios(workspace, "worlds/models");
  const auto office = workspace.folder() / "office.sdf";
  insert_before(office, "<model name=\"ground\">", "<light type=\"directional\" name=\"sun\"/>");
  const std::string visual =
      "<visual name=\"paint\"><geometry><box><size>1 1 1</size></box></geometry></visual>";
  insert_before(office, "<collision name=\"board\">", visual);
  insert_before(workspace.folder() / "models/mug/model.sdf", "<collision", visual);
  const auto scenario = workspace.load(scenario_with(
      "  sdf: office.sdf\n  models: models\n"
      "  bodies: {mug1: {settable: [x, y]}, cup: {size_m: [0.1, 0.1, 0.1], mass_kg: 0.2, "
      "position_m: [5, 5, 0.05]}}\n"));
  REQUIRE(scenario.has_value());
  const WorldSpec& world = scenario->world;
  CHECK(workspace.reports() ==
        std::vector<std::string>{
            "W5144 at 6:5: not taken over, 1 of them: lights; the first is `sun`",
            "W5144 at 35:7: not taken over, 2 of them: visuals; the first is `door::leaf`"});
  const BodySpec& mug = body(world, "mug1");
  CHECK((mug.p_WB - Eigen::Vector3d(1.8, 0.8, 0.77)).norm() < 1e-9);
  CHECK(mug.yaw_rad == doctest::Approx(0.5));
  CHECK(mug.mass_kg == doctest::Approx(0.3));
  CHECK(mug.shapes.front().form == ShapeForm::kCylinder);
  CHECK(mug.settable == std::vector<std::string>{"x", "y"});
  const JointSpec& hinge = joint(world, "door_hinge");
  CHECK(hinge.type == JointType::kHinge);
  CHECK((hinge.p_WA - Eigen::Vector3d(-0.03, -0.445, 1.05)).norm() < 1e-9);
  CHECK((hinge.axis_W - Eigen::Vector3d::UnitZ()).norm() < 1e-9);
  CHECK(hinge.low_rad == 0.0);
  CHECK(hinge.high_rad == 1.6);
  CHECK(hinge.damping_nm_s == 2.0);
  CHECK(hinge.max_torque_nm == 0.5);
  const BodySpec& leaf = body(world, "door_leaf");
  CHECK((leaf.p_WB - Eigen::Vector3d(-0.03, -0.005, 1.05)).norm() < 1e-9);
  CHECK(leaf.shapes.size() == 3);
  CHECK(leaf.shapes[1].roll_rad == doctest::Approx(0.5 * std::numbers::pi));
  CHECK(world.solver.gravity_m_s2 == doctest::Approx(-9.8));
  CHECK(world.friction.pairs.at({"mu0.6", "mu0.8"}) == 0.6);
  check_still(world, 0.001);

  OdeWorld running(world);
  REQUIRE_FALSE(running.reset(default_placements(running.layout()), 1).has_value());
  const HingeId id = *running.layout().find_hinge("door_hinge");
  running.set_hinge_motor(id, 1.0, 60.0);
  for (int i = 0; i < 1500; ++i) REQUIRE(running.step());
  CHECK(running.hinge_angle_rad(id) == doctest::Approx(1.6).epsilon(0.01));
}

TEST_CASE("a base on wheels in URDF stands still and keeps its tree") {
  if (!reads_urdf()) return;
  Workspace workspace;
  file_in_scenarios(workspace, "robots/differential_drive.urdf");
  const auto scenario = workspace.load(scenario_with(
      "  urdf: {file: differential_drive.urdf, at_m: [1, 2, 0], yaw_rad: 0.5}\n" + kCup));
  REQUIRE(scenario.has_value());
  const WorldSpec& world = scenario->world;
  CHECK(world.joints.size() == 3);  // the footprint and the camera became part of others
  const double c = std::cos(0.5), s = std::sin(0.5);
  const JointSpec& wheel = joint(world, "left_wheel_joint");
  CHECK((wheel.p_WA - Eigen::Vector3d(1.0 + 0.06 * c - 0.18 * s, 2.0 + 0.06 * s + 0.18 * c, 0.1))
            .norm() < 1e-9);
  CHECK((wheel.axis_W - Eigen::Vector3d(-s, c, 0.0)).norm() < 1e-9);
  CHECK_FALSE(wheel.high_rad.has_value());
  CHECK(body(world, "mast").shapes.size() == 2);
  check_still(world, 0.001);
}

TEST_CASE("the other worlds and robots that are shipped stand still for ten seconds") {
  for (const char* name :
       {"cafe.sdf", "storehouse.sdf", "six_joint_manipulator.urdf", "two_armed.urdf"}) {
    const bool is_sdf = std::string_view(name).ends_with(".sdf");
    if (!(is_sdf ? reads_sdf() : reads_urdf())) continue;
    CAPTURE(name);
    Workspace workspace;
    file_in_scenarios(workspace, std::string(is_sdf ? "worlds/" : "robots/") + name);
    if (is_sdf) file_in_scenarios(workspace, "worlds/models");
    const auto scenario = workspace.load(scenario_with(
        (is_sdf ? std::string("  models: models\n  sdf: ") : std::string("  urdf: ")) + name +
        "\n" + kCup));
    for (const auto& one : workspace.reports()) CHECK_MESSAGE(one.starts_with("W5144"), one);
    REQUIRE(scenario.has_value());
    check_still(scenario->world, is_sdf ? 0.001 : 0.002);
  }
}

/// Turned as far as a strong motor takes them, up and down.
void check_stops(const WorldSpec& spec) {
  for (const double sign : {1.0, -1.0}) {
    OdeWorld world(spec);
    REQUIRE_FALSE(world.reset(default_placements(world.layout()), 1).has_value());
    const auto& hinges = world.layout().hinges;
    for (std::size_t i = 0; i < hinges.size(); ++i) {
      const HingeId id = hinges.id_at(i);
      if (hinges[id].low_rad) world.set_hinge_motor(id, sign, 200.0);
    }
    for (int i = 0; i < 2500; ++i) {
      REQUIRE(world.step());
      for (std::size_t k = 0; k < hinges.size(); ++k) {
        const HingeId id = hinges.id_at(k);
        if (!hinges[id].low_rad) continue;
        CAPTURE(hinges[id].name);
        REQUIRE(world.hinge_angle_rad(id) > *hinges[id].low_rad - 0.03);
        REQUIRE(world.hinge_angle_rad(id) < *hinges[id].high_rad + 0.03);
      }
    }
  }
}

TEST_CASE("the joints of an arm stop at their limits") {
  if (!reads_urdf()) return;
  Workspace workspace;
  file_in_scenarios(workspace, "robots/six_joint_manipulator.urdf");
  const auto scenario = workspace.load(scenario_with(
      "  urdf: {file: six_joint_manipulator.urdf, fixed: true, at_m: [0, 0, 1]}\n" + kCup));
  REQUIRE(scenario.has_value());
  check_stops(scenario->world);
}

TEST_CASE("files that no reader may see are refused in one line, at their place") {
  struct BadFile {
    std::string text, report;
  };
  const std::string sdf = "<?xml version='1.0'?>\n<sdf version='1.9'><world name='w'>\n";
  const std::string end = "</world></sdf>";
  std::string deep, wide, many;
  for (int i = 0; i < 1001; ++i) many += "<model/>\n";
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  for (int i = 0; i < 30001; ++i) wide += "<a/>";
  const auto with_uri = [&](const std::string& uri) {
    return sdf + "<include><uri>" + uri + "</uri></include>" + end;
  };
  const auto with_link = [&](const std::string& inside) {
    return sdf + "<model name='m'>\n<link name='l'>" + inside + "</link></model>" + end;
  };
  const std::string box =
      "<collision name='c'><geometry><box><size>1 1 1</size></box></geometry></collision>";
  const std::string at_2 = "E5143 at 2:";
  for (const BadFile& one : std::vector<BadFile>{
           {"<!DOCTYPE x [<!ENTITY a 'aa'>]><sdf/>",
            "E5143 at 1:1: the file cannot be taken over: document types"},
           {"<sdf><![CDATA[x]]></sdf>", "E5143 at 1:6: the file cannot be taken over: CDATA"},
           {"<sdf>" + deep,
            "E5143 at 1:195: the file cannot be taken over: elements nest deeper than 64"},
           {"<sdf>" + wide + "</sdf>",
            "E5143 at 1:120002: the file cannot be taken over: there are more than"},
           {sdf + many + end,
            "E5143 at 1003:1: the file cannot be taken over: there are more than 1000 models"},
           {"<sdf a='<'/>", "E5143 at 1:8"},
           {"<sdf><a></sdf>",
            "E5143 at 1:9: the file cannot be taken over: `</sdf>` closes nothing"},
           {"", "E5143 at 1:1: the file cannot be taken over: there is no XML element"},
           {"<sdf version='1.9'/>", "E5143 at 1:1"},
           {with_uri("model://../x"),
            "E5143 at 3:10: the file cannot be taken over: `model://../x` is not included"},
           {with_uri("/etc/passwd"), "E5143 at 3:10"},
           {with_uri("file:///etc/passwd"), "E5143 at 3:10"},
           {with_uri("model://a/&#46;&#46;/x"), "E5143 at 3:10"},
           {with_uri("model://none"),
            "E5143 at 3:10: the file cannot be taken over: `model://none` is in none of"},
           {with_uri("model://out"),
            "E5143 at 3:10: the file cannot be taken over: `model://out` leads through a link"},
           {with_uri("model://ring"),
            "E5143 at 3:10: the file cannot be taken over: in `model://ring`: `model://ring` "
            "includes itself"},
           {sdf +
                "<model name='m'><pose relative_to='nowhere'>0 0 0 0 0 0</pose>\n<link "
                "name='l'/></model>" +
                end,
            "E5143 at "},
           {with_link("<inertial><mass>-1</mass></inertial>" + box), "E5143 at "},
           {with_link("<inertial><mass>nan</mass></inertial>" + box), "E5143 at "},
           {with_link("<inertial><mass>1e30</mass></inertial>" + box), "E5"},
           {with_link("<collision name='c'><geometry><box><size>1 -1 "
                      "1</size></box></geometry></collision>"),
            "E5"},
           {with_link(
                "<collision "
                "name='c'><geometry><sphere><radius>nan</radius></sphere></geometry></collision>"),
            "E5"},
       }) {
    if (!reads_sdf()) return;
    CAPTURE(one.text.substr(0, 300));
    Workspace workspace;
    workspace.write("world.sdf", one.text);
    std::filesystem::create_directories(workspace.folder() / "models/ring");
    std::filesystem::create_directory_symlink("/etc", workspace.folder() / "models/out");
    workspace.write("models/ring/model.config",
                    "<model><name>shelf</name><sdf version='1.9'>model.sdf</sdf></model>");
    workspace.write("models/ring/model.sdf", with_uri("model://ring"));
    CHECK_FALSE(
        workspace.load(scenario_with("  sdf: world.sdf\n  models: models\n" + kCup)).has_value());
    const auto reports = workspace.reports();
    REQUIRE_FALSE(reports.empty());
    CHECK(reports[0].substr(0, one.report.size()) == one.report);
    CHECK(workspace.sink.exit_code() == 3);
  }
}

TEST_CASE("a robot description that cannot be is refused at its link or joint") {
  if (!reads_urdf()) return;
  const std::string link =
      "<link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' "
      "izz='1' ixy='0' ixz='0' iyz='0'/></inertial><collision><geometry>"
      "<box size='1 1 1'/></geometry></collision></link>\n";
  const auto with = [&](const std::string& rest) {
    return "<robot name='r'>\n" + link + rest + "</robot>";
  };
  const auto joint_of = [](const std::string& type, const std::string& rest) {
    return "<link name='b'/>\n<joint name='j' type='" + type +
           "'><parent link='a'/><child link='b'/>" + rest + "</joint>";
  };
  const auto edge = [](const std::string& parent, const std::string& child) {
    return "<joint name='" + parent + child + "' type='fixed'><parent link='" + parent +
           "'/><child link='" + child + "'/></joint>\n";
  };
  for (const auto& [written, report] : std::vector<std::pair<std::string, std::string>>{
           {"<robot/>", "E5143 at 1:1"},
           {"<robot name='r'></robot>", "E5143 at 1:1"},
           {with("<link name='b'/>"), "E5143 at "},
           {with("<joint name='j' type='fixed'><parent link='a'/><child link='a'/></joint>"),
            "E5143 at "},
           {with("<joint name='j' type='fixed'><parent link='a'/><child link='none'/></joint>"),
            "E5143 at "},
           {with(joint_of("revolute", "<axis xyz='0 0 1'/>")), "E5143 at "},
           {with("<link name='b'/><link name='c'/>\n" + edge("a", "b") + edge("b", "c") +
                 edge("c", "b")),
            "E5143 at 6:1: the file cannot be taken over: the link `b` hangs on two joints"},
           {with("<link name='b'/><link name='c'/>\n" + edge("b", "c") + edge("c", "b")),
            "E5143 at 5:1: the file cannot be taken over: the link `b` hangs on itself"},
           {with("<link name='b'/>\n" + edge("a", "&#98;") + edge("b", "b")),
            "E5143 at 4:53: the file cannot be taken over: the name of a link holds a `&`"},
           {with("<link name='b'/>\n<joint name='j' type='fixed'><parent link='a'/>"
                 "<child link='b'/><child link='a'/></joint>"),
            "E5143 at 4:65: the file cannot be taken over: the joint `j` has two elements <child>"},
           {with("<link name='b' name='c'/>"), "E5143 at 3:"},
       }) {
    const std::string& text = written;
    CAPTURE(text);
    Workspace workspace;
    workspace.write("robot.urdf", text);
    CHECK_FALSE(workspace.load(scenario_with("  urdf: robot.urdf\n" + kCup)).has_value());
    const auto reports = workspace.reports();
    REQUIRE_FALSE(reports.empty());
    CHECK(reports[0].substr(0, report.size()) == report);
  }
}

TEST_CASE("a world is in one format, and its file where files may be") {
  CHECK(Loaded("  sdf: a.sdf\n  urdf: b.urdf\n").first().starts_with("E5102"));
  CHECK(Loaded("  mjcf: a.xml\n  urdf: b.urdf\n").first() ==
        "E5102 at 4:3: `mjcf` is not a key of `world`, which has `urdf`");
  if (!reads_sdf()) {
    CHECK(Loaded("  sdf: a.sdf\n").first() ==
          "E5142 at 4:3: `sdf` cannot be read: this program was built without libsdformat-dev");
    return;
  }
  CHECK(Loaded("  sdf: none.sdf\n").first().starts_with("E0001 at 4:8"));
  CHECK(Loaded("  sdf: /etc/passwd\n").first().starts_with("E1016 at 4:8"));
  CHECK(Loaded("  sdf: {fil: x}\n").first() == "E5106 at 4:3: `sdf` lacks the key `file`");
}

}  // namespace
}  // namespace parallax::harness::test
