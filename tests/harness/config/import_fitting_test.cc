// Files that say what a simulator cannot have: where joints stand at first, bodies with several
// joints, links without mass, inertias that no body has.

#include <doctest/doctest.h>

#include "harness/import/mesh.h"
#include "tests/harness/config/mjcf_text.h"

namespace parallax::harness::test {
namespace {

const std::string kBox = "<collision><geometry><box size='0.1 0.1 0.4'/></geometry></collision>";

std::string urdf_link(const std::string& name, double mass_kg, const std::string& moments,
                      const std::string& more = kBox) {
  return "<link name='" + name + "'><inertial><mass value='" + std::to_string(mass_kg) + "'/>" +
         "<inertia " + moments + " ixy='0' ixz='0' iyz='0'/></inertial>" + more + "</link>\n";
}

const std::string kMoments = "ixx='0.02' iyy='0.02' izz='0.02'";

/// Joint `j` from `a` to `b`, one metre above, about y.
std::string urdf_joint(const std::string& name, const std::string& parent, const std::string& child,
                       const std::string& limit, const std::string& type = "revolute") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='0 0 1'/><axis xyz='0 1 0'/>" + limit +
         "</joint>\n";
}

std::string limit_of(double low, double high) {
  return "<limit lower='" + std::to_string(low) + "' upper='" + std::to_string(high) +
         "' effort='0' velocity='0'/>";
}

std::optional<Scenario> loaded(Workspace& workspace, const std::string& robot,
                               const std::string& more = {}) {
  workspace.write("robot.urdf", "<robot name='r'>\n" + robot + "</robot>");
  return workspace.load(scenario_with("  urdf: {file: robot.urdf, at_m: [0, 0, 2], fixed: true" +
                                      more + "}\n" + kCup));
}

bool is_reported(Workspace& workspace, const std::string& part) {
  const auto all = workspace.reports();
  return std::any_of(all.begin(), all.end(),
                     [&](const std::string& one) { return one.find(part) != one.npos; });
}

TEST_CASE("a joint whose stops exclude 0 begins between them, and counts from there") {
  if (!reads_urdf()) return;
  Workspace workspace;
  const auto scenario =
      loaded(workspace, urdf_link("a", 1, kMoments) + urdf_link("b", 1, kMoments) +
                            urdf_link("c", 1, kMoments) +
                            urdf_joint("elbow", "a", "b", limit_of(-2.0, -1.0)) +
                            urdf_joint("wrist", "b", "c", limit_of(-1.0, 1.0)));
  REQUIRE(scenario.has_value());
  CHECK(is_reported(workspace, "the first is `elbow, at -1.5`"));
  const auto& elbow = joint(scenario->world, "elbow");
  CHECK(*elbow.low_rad == doctest::Approx(-0.5));
  CHECK(*elbow.high_rad == doctest::Approx(0.5));
  // Turned by -1.5 about y at (0, 0, 3): up becomes -x.
  const auto& wrist = joint(scenario->world, "wrist");
  CHECK((wrist.p_WA - Eigen::Vector3d(std::sin(-1.5), 0.0, 3.0 + std::cos(-1.5))).norm() < 1e-6);
  CHECK((body(scenario->world, "c").p_WB - wrist.p_WA).norm() < 1e-6);
  CHECK((wrist.axis_W - Eigen::Vector3d::UnitY()).norm() < 1e-9);
  CHECK(*wrist.low_rad == -1.0);
}

TEST_CASE("`positions` says where joints begin, and no other joint") {
  if (!reads_urdf()) return;
  const auto robot = urdf_link("a", 1, kMoments) + urdf_link("b", 1, kMoments) +
                     urdf_joint("elbow", "a", "b", limit_of(-2.0, 1.0));
  Workspace workspace;
  const auto scenario = loaded(workspace, robot, ", positions: {elbow: 0.5}");
  REQUIRE(scenario.has_value());
  CHECK_FALSE(is_reported(workspace, "positions 0"));
  CHECK(*joint(scenario->world, "elbow").low_rad == doctest::Approx(-2.5));
  CHECK(*joint(scenario->world, "elbow").high_rad == doctest::Approx(0.5));
  for (const auto& [more, said] : std::vector<std::pair<std::string, std::string>>{
           {", positions: {elbow: 1.5}", "beyond its stops"},
           {", positions: {albow: 0.5}", "there is no joint of that name that moves"},
           {", positions: {elbow: far}", "E5107"}}) {
    CAPTURE(more);
    Workspace other;
    CHECK_FALSE(loaded(other, robot, more).has_value());
    CHECK(is_reported(other, said));
  }
}

TEST_CASE("a hinge without way is fixed, and so is what a joint moves that has no mass") {
  if (!reads_urdf()) return;
  Workspace workspace;
  const auto scenario = loaded(
      workspace, urdf_link("a", 1, kMoments) + urdf_link("b", 2, kMoments) + "<link name='tip'>" +
                     kBox + "</link>" + urdf_joint("stuck", "a", "b", limit_of(0.0, 0.0)) +
                     urdf_joint("turn", "b", "tip", limit_of(-1.0, 1.0)));
  REQUIRE(scenario.has_value());
  CHECK(joint(scenario->world, "stuck").type == JointType::kFixed);
  CHECK(
      is_reported(workspace, "joints whose stops leave no way (held fast); the first is `stuck`"));
  CHECK(is_reported(workspace, "joints of links without mass (held fast); the first is `turn`"));
  CHECK(body(scenario->world, "b").shapes.size() == 2);
}

TEST_CASE("a root without mass stands fast, and a link between two joints gets a share") {
  if (!reads_urdf()) return;
  Workspace workspace;
  workspace.write("robot.urdf", "<robot name='r'>\n<link name='root'>" + kBox + "</link>" +
                                    "<link name='cross'/>" + urdf_link("arm", 2, kMoments) +
                                    urdf_joint("pan", "root", "cross", limit_of(-1.0, 1.0)) +
                                    urdf_joint("tilt", "cross", "arm", limit_of(-1.0, 1.0)) +
                                    "</robot>");
  const auto scenario =
      workspace.load(scenario_with("  urdf: {file: robot.urdf, at_m: [0, 0, 2]}\n" + kCup));
  REQUIRE(scenario.has_value());
  CHECK(is_reported(workspace, "roots without mass (they stand fast); the first is `root`"));
  CHECK(is_reported(workspace, "each has 2 % of the mass behind it); the first is `cross`"));
  CHECK(body(scenario->world, "root").mass_kg == 0.0);
  CHECK(body(scenario->world, "cross").mass_kg == doctest::Approx(0.04));
  CHECK(body(scenario->world, "arm").mass_kg == doctest::Approx(1.96));
  CHECK_FALSE(body(scenario->world, "cross").collides);
  // The share lies where the arm does: a metre above the cross.
  CHECK((body(scenario->world, "cross").inertia->p_BC - Eigen::Vector3d(0, 0, 1)).norm() < 1e-9);
}

TEST_CASE("inertias that no body has are raised, or those of the shapes") {
  if (!reads_urdf()) return;
  Workspace workspace;
  const auto scenario = loaded(workspace, urdf_link("a", 1, "ixx='0.01' iyy='0.02' izz='0.05'") +
                                              urdf_link("b", 3, "ixx='0' iyy='0' izz='0'") +
                                              urdf_joint("elbow", "a", "b", limit_of(-1.0, 1.0)));
  REQUIRE(scenario.has_value());
  const auto& raised = body(scenario->world, "a").inertia;
  REQUIRE(raised.has_value());
  CHECK(raised->I_C_kg_m2(0, 0) == doctest::Approx(0.02));
  CHECK(raised->I_C_kg_m2(1, 1) == doctest::Approx(0.03));
  CHECK(raised->I_C_kg_m2(2, 2) == doctest::Approx(0.05));
  CHECK_FALSE(body(scenario->world, "b").inertia.has_value());
  CHECK(is_reported(workspace, "inertias that no body has"));
  CHECK(is_reported(workspace, "inertias with a moment that is not positive"));
}

TEST_CASE("several joints of a body in MJCF move it one after the other") {
  if (skips_mjcf()) return;
  Workspace workspace;
  const auto scenario = taken_over(
      workspace,
      bodies_with("<body name='b' pos='0 0 1'><joint name='x' type='slide' axis='1 0 0'/>"
                  "<joint name='z' type='slide' axis='0 0 1'/><joint name='turn' axis='0 1 0'/>"
                  "<geom type='box' size='0.1 0.1 0.1' mass='1'/></body>"));
  REQUIRE(scenario.has_value());
  const auto& x = joint(scenario->world, "x");
  const auto& z = joint(scenario->world, "z");
  const auto& turn = joint(scenario->world, "turn");
  CHECK(x.parent.empty());
  CHECK(x.child == "b_moved_by_x");
  CHECK(z.parent == "b_moved_by_x");
  CHECK(turn.parent == "b_moved_by_z");
  CHECK(turn.child == "b");
  CHECK(turn.type == JointType::kHinge);
  const double all = body(scenario->world, "b").mass_kg +
                     body(scenario->world, "b_moved_by_x").mass_kg +
                     body(scenario->world, "b_moved_by_z").mass_kg;
  CHECK(all == doctest::Approx(1.0));
  CHECK(is_reported(workspace, "links without mass between joints"));
}

TEST_CASE("SDF with inertias or sensors that its library refuses is read without them") {
  if (!reads_sdf()) return;
  const auto with = [](const std::string& in_link) {
    return "<sdf version='1.9'>\n<model name='m'><pose>0 0 3 0 0 0</pose><link name='l'>"
           "<inertial><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.9</izz>"
           "</inertia></inertial>" +
           in_link +
           "<collision name='c'><geometry><box><size>1 1 1</size></box></geometry></collision>"
           "</link></model>\n</sdf>";
  };
  for (const std::string& more :
       {std::string(), std::string("<sensor name='s' type='of no kind'/>")}) {
    CAPTURE(more);
    Workspace workspace;
    workspace.write("world.sdf", with(more));
    const auto scenario = workspace.load(scenario_with("  sdf: world.sdf\n" + kCup));
    REQUIRE(scenario.has_value());
    const auto& inertia = body(scenario->world, "m").inertia;
    REQUIRE(inertia.has_value());
    CHECK(inertia->I_C_kg_m2(0, 0) == doctest::Approx(0.45));
    CHECK(inertia->I_C_kg_m2(2, 2) == doctest::Approx(0.9));
    CHECK(is_reported(workspace, "inertias that no body has"));
    CHECK(is_reported(workspace, "sensors") == !more.empty());
  }
}

TEST_CASE("a way up to a mesh or an include is followed below the folders of the world") {
  if (skips_mjcf() || !reads_meshes()) return;
  Workspace workspace;
  std::filesystem::create_directories(workspace.folder() / "meshes");
  std::filesystem::create_directories(workspace.folder() / "parts");
  workspace.write("meshes/t.obj", kTetrahedron);
  workspace.write("parts/arm.xml",
                  "<mujoco><compiler meshdir='parts'/><asset><mesh name='t' "
                  "file='../meshes/t.obj'/></asset></mujoco>");
  const auto scenario = taken_over(
      workspace,
      "<mujoco><include file='meshes/../parts/arm.xml'/><worldbody><body name='b' pos='0 0 1'>"
      "<freejoint/><geom type='mesh' mesh='t'/></body></worldbody></mujoco>");
  REQUIRE(scenario.has_value());
  CHECK(body(scenario->world, "b").shapes.size() == 1);
}

TEST_CASE("a joint follows another one as the file says, and both count from where they begin") {
  if (!reads_urdf()) return;
  const auto robot = [](const std::string& mimic, const std::string& range) {
    return urdf_link("a", 1, kMoments) + urdf_link("b", 1, kMoments) + urdf_link("c", 1, kMoments) +
           urdf_link("d", 1, kMoments) + urdf_joint("one", "a", "b", limit_of(-1.0, 1.0)) +
           urdf_joint("two", "a", "c", range + mimic) +
           urdf_joint("three", "a", "d",
                      limit_of(-9.0, 9.0) + "<mimic joint='two' multiplier='0.5'/>");
  };
  const std::string mimic = "<mimic joint='one' multiplier='-2' offset='0.4'/>";
  Workspace workspace;
  const auto scenario =
      loaded(workspace, robot(mimic, limit_of(-0.6, 3.0)), ", positions: {one: 0.1}");
  REQUIRE(scenario.has_value());
  const auto &one = joint(scenario->world, "one"), &two = joint(scenario->world, "two"),
             &three = joint(scenario->world, "three");
  REQUIRE(two.follows.has_value());
  CHECK(two.follows->leader == "one");
  CHECK(two.follows->ratio == -2.0);
  // Through the one between.
  REQUIRE(three.follows.has_value());
  CHECK(three.follows->leader == "one");
  CHECK(three.follows->ratio == -1.0);
  // -0.6 <= 0.4 - 2 q <= 3: q is from -1.3 to 0.5, and begins at 0.1.
  CHECK(*one.low_rad == doctest::Approx(-1.1));
  CHECK(*one.high_rad == doctest::Approx(0.4));
  CHECK_FALSE(two.low_rad.has_value());
  // At first `two` is at 0.2, about y at (0, 0, 3).
  CHECK_FALSE(is_reported(workspace, "follow"));
  const auto world = make_world(scenario->world);
  const auto reset = world->reset(default_placements(world->layout()), 1);
  CHECK_FALSE(reset.has_value());
  const auto& c = body(scenario->world, "c");
  CHECK(c.shapes.front().pitch_rad == doctest::Approx(0.2));
}

TEST_CASE("a joint that can follow nothing is said to move freely, or to be held") {
  if (!reads_urdf()) return;
  const auto robot = [](const std::string& mimic, const std::string& leader) {
    return urdf_link("a", 1, kMoments) + urdf_link("b", 1, kMoments) + urdf_link("c", 1, kMoments) +
           urdf_joint("one", "a", "b", limit_of(-1.0, 1.0), leader) +
           urdf_joint("two", "a", "c", limit_of(-1.0, 1.0) + mimic);
  };
  struct FollowCase {
    const char *mimic, *leader, *said, *more;
  };
  for (const FollowCase& one : std::vector<FollowCase>{
           {"<mimic joint='two'/>", "revolute", "joints that follow none that moves", ""},
           {"<mimic joint='none'/>", "revolute", "joints that follow none that moves", ""},
           {"<mimic joint='one' multiplier='0'/>", "revolute", "joints that follow none", ""},
           {"<mimic joint='one'/>", "fixed", "joints that follow one that is held fast", ""},
           {"<mimic joint='one' offset='5'/>", "revolute", "which leave these no way", ""},
           {"<mimic joint='one'/>", "revolute", "which follows `one`",
            ", positions: {two: 0.5}"}}) {
    CAPTURE(one.mimic);
    CAPTURE(one.leader);
    Workspace workspace;
    const auto scenario = loaded(workspace, robot(one.mimic, one.leader), one.more);
    CHECK(is_reported(workspace, one.said));
    CHECK(scenario.has_value() == (std::string_view(one.more).empty()));
  }
}

}  // namespace
}  // namespace parallax::harness::test
