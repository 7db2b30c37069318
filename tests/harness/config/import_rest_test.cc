// Every part of a description that is not taken over is listed, wherever it stands; every part that
// is taken over has an effect.

#include <array>
#include <string>
#include <vector>

#include "harness/import/import.h"
#include "harness/import/mesh.h"
#include "tests/harness/config/imported_world.h"

namespace parallax::harness::test {
namespace {

const std::string kSdfModel = R"(<?xml version='1.0'?>
<sdf version='1.9'><world name='w'><gravity>0 0 -9.8</gravity>
<model name='m'><pose>0 0 1 0 0 0</pose><self_collide>false</self_collide><frame name='f'><pose>0 0 0 0 0 0</pose></frame>
<link name='a'><inertial><mass>1</mass><pose>0 0 0 0 0 0</pose><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>
<collision name='c'><geometry><box><size>1 1 1</size></box></geometry><surface><friction><ode><mu>0.5</mu></ode></friction></surface></collision></link>
<link name='b'><pose>0 0 2 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>
<collision name='s'><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
<collision name='y'><geometry><cylinder><radius>0.1</radius><length>1</length></cylinder></geometry></collision></link>
<joint name='j' type='revolute'><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>1</upper></limit><dynamics><damping>1</damping><friction>0</friction></dynamics></axis></joint>
</model></world></sdf>
)";
const std::string kUrdfModel = R"(<robot name='r'>
<link name='a'><inertial><origin xyz='0 0 0'/><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>
<collision name='c'><origin xyz='0 0 0'/><geometry><box size='1 1 1'/></geometry></collision></link>
<link name='b'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>
<collision><geometry><cylinder radius='0.1' length='1'/></geometry></collision></link>
<joint name='j' type='revolute'><parent link='a'/><child link='b'/><origin xyz='0 0 2'/><axis xyz='0 0 1'/>
<limit lower='-1' upper='1' effort='0' velocity='0'/><dynamics damping='1' friction='0'/></joint></robot>
)";

ImportedWorld imported(bool is_sdf, const std::string& text) {
  ImportInput input;
  input.text = text;
  return is_sdf ? import_sdf(input) : import_urdf(input);
}

bool lists(const ImportedWorld& world, const std::string& word) {
  return std::any_of(world.left_out.begin(), world.left_out.end(),
                     [&](const LeftOut& one) { return one.what.find(word) != std::string::npos; });
}

/// Is it listed, or the file refused, wherever an element, or an attribute, of this kind stands?
void check_planted(bool is_sdf, const std::string& text, const std::string& element,
                   const std::string& attribute, const std::string& word) {
  const ImportedWorld plain = imported(is_sdf, text);
  REQUIRE_MESSAGE(!plain.fault, plain.fault->message);
  CHECK(plain.left_out.empty());
  std::size_t places = 0;
  for (std::size_t at = text.find("?>") == text.npos ? 0 : text.find("?>"); at < text.size();
       ++at) {
    if (text[at] != '>' || text[at - 1] == '?') continue;
    const bool is_end =
        text.rfind("</", at) != text.npos && text.rfind('<', at) == text.rfind("</", at);
    if (is_end) continue;
    const bool is_empty = text[at - 1] == '/';
    for (const bool is_attribute : {true, false}) {
      if (is_empty && !is_attribute) continue;
      // An element beside a plain value, as in `<mass>1<x/></mass>`, is no part of either format.
      if (!is_attribute && text[at + 1] != '<' && text[at + 1] != '\n') continue;
      std::string with = text;
      with.insert(is_attribute ? at - (is_empty ? 1 : 0) : at + 1,
                  is_attribute ? " " + attribute : element);
      const ImportedWorld world = imported(is_sdf, with);
      CAPTURE(with);
      CHECK((world.fault || lists(world, word)));
      ++places;
    }
  }
  CHECK(places > 20);
}

TEST_CASE("an element or an attribute that nobody knows is listed at every place") {
  if (reads_sdf()) check_planted(true, kSdfModel, "<zebra/>", "zebra='1'", "zebra");
  if (reads_urdf()) check_planted(false, kUrdfModel, "<zebra/>", "zebra='1'", "zebra");
}

TEST_CASE("rare elements that change how a thing moves are listed, their defaults are not") {
  if (!reads_sdf()) return;
  for (const auto& [element, before, is_listed] : std::vector<std::array<std::string, 3>>{
           {"<gravity>false</gravity>", "<inertial>", "yes"},
           {"<gravity>0</gravity>", "<inertial>", "yes"},
           {"<gravity>true</gravity>", "<inertial>", ""},
           {"<kinematic>true</kinematic>", "<inertial>", "yes"},
           {"<kinematic>false</kinematic>", "<inertial>", ""},
           {"<enable_wind>true</enable_wind>", "<inertial>", "yes"},
           {"<velocity_decay><linear>1</linear></velocity_decay>", "<inertial>", "yes"},
           {"<allow_auto_disable>false</allow_auto_disable>", "<link name='a'>", "yes"},
           {"<bounce><restitution_coefficient>1</restitution_coefficient></bounce>", "<friction>",
            "yes"},
           {"<contact><collide_bitmask>1</collide_bitmask></contact>", "<friction>", "yes"},
           {"<mu2>0.1</mu2>", "<mu>", "yes"},
           {"<fdir1>1 0 0</fdir1>", "<mu>", "yes"},
           {"<slip1>0.1</slip1>", "<mu>", "yes"},
           {"<slip1>0</slip1>", "<mu>", ""},
           {"<stiffness>10</stiffness>", "<lower>", "yes"},
           {"<physics><ode><cfm_damping>true</cfm_damping></ode></physics>", "<axis>", "yes"},
           {"<wind><linear_velocity>1 0 0</linear_velocity></wind>", "<model name='m'>", "yes"},
       }) {
    std::string text = kSdfModel;
    text.insert(text.find(before), element);
    CAPTURE(element);
    const ImportedWorld world = imported(true, text);
    REQUIRE_FALSE(world.fault.has_value());
    const auto end = element.find('>');
    CHECK(lists(world, element.substr(0, end + 1)) == !is_listed.empty());
    CHECK(world.left_out.empty() == is_listed.empty());
  }
}

TEST_CASE("a model that stands in no world stands where it says") {
  if (!reads_sdf()) return;
  const std::string model =
      "<model name='m'><static>true</static><pose>1 2 3 0 0 0.5</pose><link name='l'>"
      "<pose>0.5 0 0 0 0 0</pose><collision name='c'><geometry><box><size>1 1 1</size></box>"
      "</geometry></collision></link></model>";
  const auto alone = imported(true, "<sdf version='1.9'>" + model + "</sdf>");
  const auto in_world =
      imported(true, "<sdf version='1.9'><world name='w'>" + model + "</world></sdf>");
  REQUIRE(alone.bodies.size() == 1);
  REQUIRE(in_world.bodies.size() == 1);
  CHECK((alone.bodies[0].spec.p_WB - in_world.bodies[0].spec.p_WB).norm() < 1e-12);
  CHECK(alone.bodies[0].spec.yaw_rad == doctest::Approx(0.5));
  CHECK(alone.bodies[0].spec.p_WB.x() == doctest::Approx(1.0 + 0.5 * std::cos(0.5)));
}

TEST_CASE("an inertia that no body can have is mended, and told at its link") {
  if (!reads_sdf()) return;
  std::string text = kSdfModel;
  const auto at = text.find("<izz>1", text.find("name='b'"));
  const auto world = imported(true, text.replace(at, 6, "<izz>9"));
  REQUIRE_FALSE(world.fault.has_value());
  const auto told = std::find_if(
      world.left_out.begin(), world.left_out.end(),
      [](const LeftOut& one) { return one.what.starts_with("inertias that no body has"); });
  REQUIRE(told != world.left_out.end());
  CHECK(told->offset == text.find("<link name='b'"));
}

TEST_CASE("a root without mass stands fast, which is told unless it is held in the world") {
  if (!reads_urdf()) return;
  std::string text = kUrdfModel;
  const auto begin = text.find("<inertial>"), end = text.find("</inertial>") + 11;
  text.erase(begin, end - begin);
  const auto free = imported(false, text);
  REQUIRE_FALSE(free.fault.has_value());
  CHECK(std::any_of(free.left_out.begin(), free.left_out.end(), [](const LeftOut& one) {
    return one.what == "motions of roots without mass (they stand fast)" && one.first == "a";
  }));
  ImportInput input;
  input.text = text;
  input.fixed = true;
  const auto held = import_urdf(input);
  REQUIRE_FALSE(held.fault.has_value());
  CHECK(held.bodies.size() == 2);
  CHECK(held.joints.size() == 1);
  // So may one that hangs by a fixed joint on a link that stands for the world.
  std::string hung = text;
  hung.insert(hung.find("<link name='a'"), "<link name='world'/>");
  hung.insert(hung.find("<joint name='j'"),
              "<joint name='h' type='fixed'><parent link='world'/><child link='a'/></joint>");
  CHECK_FALSE(imported(false, hung).fault.has_value());
}

TEST_CASE("lines, points and faces without area are no surface, and what is open is told") {
  if (!reads_meshes()) return;
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 40 0 0\n";
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const auto read = [](const std::string& text) {
    return mesh_corners(text, "obj", Eigen::Vector3d::Ones());
  };
  for (const char* more : {"", "l 1 5\n", "p 5\n", "f 1 2 5\n", "f 1 5 5\n"}) {
    CAPTURE(more);
    const auto made = read(corners + faces + more);
    REQUIRE_FALSE(made.fault.has_value());
    double farthest = 0.0;
    for (const auto& corner : made.corners) farthest = std::max(farthest, corner.x());
    CHECK(farthest == doctest::Approx(1.0));
  }
  CHECK_FALSE(read(corners + faces).is_open);
  CHECK(losses_of(read(corners + faces), "m").empty());
  // Faces that do not agree on an outside still close it in.
  CHECK_FALSE(read(corners + "f 1 2 3\nf 1 2 4\nf 1 4 3\nf 2 3 4\n").is_open);
  const std::string open = "f 1 3 2\nf 1 2 4\nf 1 4 3\n", back = "f 1 2 3\nf 1 4 2\nf 1 3 4\n";
  for (const auto& text : {corners + open, corners + open + back}) {
    const auto made = read(text);
    CHECK(made.is_open);
    const auto losses = losses_of(made, "m");
    REQUIRE(losses.size() == 1);
    CHECK(losses[0].what.starts_with("meshes that are not closed"));
  }
}

}  // namespace
}  // namespace parallax::harness::test
