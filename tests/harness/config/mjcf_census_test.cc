// Whatever MJCF can say is taken over or listed: MuJoCo's own schema is walked.

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <sstream>

#include "harness/world/shapes.h"
#include "tests/harness/config/mjcf_text.h"

namespace parallax::harness::test {
namespace {

/// An element of the schema: the tags from the outermost on, and its attributes.
struct Row {
  std::vector<std::string> path;
  std::vector<std::string> attributes;
  const std::string& tag() const { return path.back(); }
};

/// Levels are indented by three columns; names stand left of column 30, attributes from there on.
std::vector<Row> schema() {
  std::vector<char> text(1 << 20U);
  REQUIRE(mj_printSchema(nullptr, text.data(), static_cast<int>(text.size()), 0, 0) > 0);
  std::vector<Row> rows;
  std::vector<std::string> open;
  std::istringstream lines(text.data());
  for (std::string line; std::getline(lines, line);) {
    const auto begin = line.find_first_not_of(' ');
    if (begin == line.npos) continue;
    std::istringstream words(line);
    if (begin < 27) {
      std::string tag, times;
      words >> tag >> times;
      if (tag == "(world)body") tag = "body";
      open.resize(begin / 3);
      open.push_back(tag);
      rows.push_back({open, {}});
    }
    for (std::string word; words >> word;) rows.back().attributes.push_back(word);
  }
  return rows;
}

using Words = std::map<std::string, std::string>;

std::set<std::string> words_of(const std::string& text) {
  std::istringstream words(text);
  std::set<std::string> out;
  for (std::string word; words >> word;) out.insert(word);
  return out;
}

const std::string kTurns = " quat axisangle xyaxes zaxis euler ";

/// Attributes that are taken over, by tag.
const Words kTakenOver = {
    {"mujoco", "model"},
    {"compiler",
     "autolimits boundmass boundinertia settotalmass balanceinertia strippath coordinate angle "
     "fitaabb eulerseq meshdir texturedir discardvisual convexhull usethread fusestatic "
     "inertiafromgeom inertiagrouprange exactmeshinertia"},
    {"option", "gravity"},
    {"flag", "gravity filterparent contact"},
    {"default", "class"},
    {"mesh", "name class file vertex face refpos refquat scale"},
    {"body", "name childclass pos" + kTurns},
    {"inertial", "pos mass diaginertia fullinertia" + kTurns},
    {"joint", "name class type pos axis limited range ref damping frictionloss"},
    {"freejoint", "name"},
    {"geom",
     "name class type contype conaffinity size friction mass density shellinertia fromto mesh "
     "fitscale pos" +
         kTurns},
    {"exclude", "name body1 body2"},
};

/// Attributes without which an element is refused.
const Words kNeeded = {
    {"geom", "size='0.1 0.1 0.1'"},
    {"inertial", "pos='0 0 0' mass='1' diaginertia='0.01 0.02 0.025'"},
    {"mesh", "name='new' vertex='0 0 0 0.2 0 0 0 0.2 0 0 0 0.2'"},
    {"hfield", "name='other' nrow='2' ncol='2' size='1 1 1 1'"},
    {"texture", "name='x' type='2d' builtin='flat' width='2' height='2'"},
    {"material", "name='blue'"},
    {"numeric", "name='n' data='1'"},
    {"text", "name='t' data='x'"},
    {"tuple", "name='u'"},
    {"exclude", "body1='a' body2='c'"},
    {"pair", "geom1='g' geom2='k'"},
    {"connect", "body1='a' anchor='0 0 0'"},
    {"weld", "body1='a'"},
    {"distance", "geom1='g' geom2='k'"},
    {"intvelocity", "joint='j' actrange='-1 1'"},
    {"damper", "joint='j' ctrlrange='0 1'"},
    {"adhesion", "body='a' ctrlrange='0 1'"},
    {"equality/joint", "joint1='j'"},
    {"equality/tendon", "tendon1='t'"},
    {"key", "name='home'"},
    {"user", "dim='1' needstage='pos' datatype='real' objtype='body' objname='a'"},
    {"subtreecom", "body='a'"},
    {"subtreelinvel", "body='a'"},
    {"subtreeangmom", "body='a'"},
    {"ballquat", "joint='ball'"},
    {"ballangvel", "joint='ball'"},
    {"magnetometer", "site='s'"},
};

/// Attributes of geoms that name what is listed itself.
const Words kListedByName = {{"material", "materials"}, {"hfield", "elements <hfield> of <asset>"}};

/// Names for the references of elements, by attribute.
const Words kReferences = {{"site", "s"},     {"joint", "j"},      {"tendon", "t"},
                           {"actuator", "m"}, {"objtype", "body"}, {"objname", "a"}};

/// Children without which an element is refused.
const Words kInside = {
    {"tuple", "<element objtype='body' objname='a'/>"},
    {"spatial", "<site site='s'/><site site='s2'/>"},
    {"fixed", "<joint joint='j' coef='1'/>"},
};

/// An attribute as it is planted, with what it needs; otherwise it stands beside kNeeded.
const Words kPlanted = {
    {"mujoco/model", "model='m'"},
    {"gravity", "gravity='0 0 -5'"},
    {"wind", "wind='1 0 0'"},
    {"magnetic", "magnetic='1 0 0'"},
    {"o_solref", "o_solref='0.05 1'"},
    {"o_solimp", "o_solimp='0.5 0.6 0.01'"},
    {"integrator", "integrator='RK4'"},
    {"collision", "collision='dynamic'"},
    {"cone", "cone='elliptic'"},
    {"jacobian", "jacobian='dense'"},
    {"solver", "solver='CG'"},
    {"iterations", "iterations='7'"},
    {"noslip_iterations", "noslip_iterations='7'"},
    {"mpr_iterations", "mpr_iterations='7'"},
    {"condim", "condim='6'"},
    {"group", "group='3'"},
    {"priority", "priority='2'"},
    {"solref", "solref='0.05 1'"},
    {"solimp", "solimp='0.5 0.6 0.01'"},
    {"solreflimit", "solreflimit='0.05 1'"},
    {"solimplimit", "solimplimit='0.5 0.6 0.01'"},
    {"solreffriction", "solreffriction='0.05 1'"},
    {"solimpfriction", "solimpfriction='0.5 0.6 0.01'"},
    {"rgba", "rgba='1 0 0 1'"},
    {"fluidshape", "fluidshape='ellipsoid'"},
    {"fluidcoef", "fluidcoef='1 1 1 1 1'"},
    {"mocap", "mocap='true'"},
    {"smoothnormal", "smoothnormal='true'"},
    {"normal", "normal='1 0 0 1 0 0 1 0 0 1 0 0'"},
    {"texcoord", "texcoord='0 0 0 1 1 0 1 1'"},
    {"springdamper", "springdamper='1 1'"},
    {"material", "material='red'"},
    {"hfield", "type='hfield' hfield='h'"},
    {"friction", "friction='1.7'"},
    {"pos", "pos='0.3 0 0.1'"},
    {"quat", "quat='0.8 0.6 0 0'"},
    {"axisangle", "axisangle='1 0 0 40'"},
    {"xyaxes", "xyaxes='0 1 0 -1 0 0.3'"},
    {"zaxis", "zaxis='1 1 1'"},
    {"euler", "euler='10 20 30'"},
    {"class", "class='special'"},
    {"childclass", "childclass='special'"},
    {"name", "name='renamed'"},
    {"type", "type='slide'"},
    {"axis", "axis='1 0 0'"},
    {"limited", "limited='true' range='-20 20'"},
    {"range", "limited='true' range='-30 30'"},
    {"ref", "ref='5' limited='true' range='-20 20'"},
    {"scale", "scale='1 2 3'"},
    {"refpos", "refpos='0.1 0 0'"},
    {"refquat", "refquat='0.8 0.6 0 0'"},
    {"geom/name", "name='renamed' size='0.1 0.1 0.1'"},
    {"geom/type", "type='box' size='0.1 0.1 0.1'"},
    {"geom/contype", "contype='0' conaffinity='0' size='0.1 0.1 0.1'"},
    {"geom/conaffinity", "contype='0' conaffinity='0' size='0.1 0.1 0.1'"},
    {"geom/size", "size='0.2 0.1 0.1'"},
    {"geom/fromto", "type='capsule' fromto='0 0 0 0 0.2 0.3' size='0.05'"},
    {"geom/shellinertia", "type='mesh' mesh='tetra' shellinertia='true'"},
    {"geom/mesh", "type='mesh' mesh='tetra'"},
    {"geom/fitscale", "type='box' mesh='tetra' fitscale='2'"},
    {"inertial/pos", "pos='0.1 0 0' mass='1' diaginertia='0.01 0.02 0.025'"},
    {"inertial/mass", "pos='0 0 0' mass='2' diaginertia='0.01 0.02 0.025'"},
    {"inertial/diaginertia", "pos='0 0 0' mass='1' diaginertia='0.02 0.02 0.025'"},
    {"inertial/fullinertia", "pos='0 0 0' mass='1' fullinertia='0.01 0.02 0.025 0.001 0 0'"},
};

std::string planted(const std::string& tag, const std::string& attribute) {
  const auto needed = kNeeded.find(tag);
  const std::string rest = needed == kNeeded.end() ? "" : needed->second + " ";
  if (const auto own = kPlanted.find(tag + "/" + attribute); own != kPlanted.end()) {
    return own->second;
  }
  const auto usual = kPlanted.find(attribute);
  if (tag == "flag") {
    const bool is_off = words_of("override energy fwdinv sensornoise multiccd").contains(attribute);
    return attribute + (is_off ? "='enable'" : "='disable'");
  }
  return rest + (usual == kPlanted.end() ? attribute + "='0.37'" : usual->second);
}

/// The same in a default class, which has no need of others.
std::string in_class(const std::string& attribute) {
  const auto usual = kPlanted.find(attribute);
  return usual == kPlanted.end() ? attribute + "='0.37'" : usual->second;
}

std::string element(const std::string& tag, const std::string& attributes,
                    const std::string& inside) {
  return "<" + tag + " " + attributes + ">" + inside + "</" + tag + ">";
}

/// A file with such an element in it, at its place in the schema.
std::string file_having(const Row& row, const std::string& attributes) {
  std::string model, body, planted_element;
  if (row.path.size() == 1) {
    model = attributes;
  } else {
    const auto in = kInside.find(row.tag());
    planted_element = element(row.tag(), attributes, in == kInside.end() ? "" : in->second);
    for (std::size_t i = row.path.size() - 1; i-- > 1;) {
      if (row.path[i] != "body") planted_element = element(row.path[i], "", planted_element);
    }
  }
  const bool is_in_body = row.path.size() > 2 && row.path[1] == "body";
  // A joint, so that inertias matter, but where only what stands can have the attribute.
  const bool stands = attributes.find("hfield") != attributes.npos ||
                      attributes.find("mocap") != attributes.npos || row.tag() == "joint" ||
                      row.tag() == "freejoint";
  const std::string joint = stands ? "" : "<joint name='own_joint'/>";
  std::string own = "<body name='new' pos='0 5 1'>" + joint + (is_in_body ? planted_element : "") +
                    "<geom name='own' size='0.1' pos='0 0 0.3'/></body>";
  if (row.path.size() == 2 && row.tag() == "body") {
    own = "<body " + attributes + ">" + joint + "<geom size='0.1' pos='0 0 0.3'/></body>";
  }
  const bool is_section = row.path.size() > 1 && row.path[1] != "body";
  return "<mujoco " + model +
         R"(><default><default class='special'><geom density='77'/><joint damping='7'/>
<mesh scale='3 3 3'/></default></default>
<asset><material name='red'/><hfield name='h' nrow='2' ncol='2' size='1 1 1 1'/>
<mesh name='tetra' vertex='0 0 0 0.2 0 0 0 0.2 0 0 0 0.2'/></asset>
<worldbody><body name='a' pos='0 0 1'><joint name='j' limited='true' range='-50 50'/>
<geom name='g' size='0.1'/><site name='s'/><site name='s2' pos='0.1 0 0'/></body>
<body name='c' pos='3 0 1'><freejoint/><geom name='k' size='0.1'/></body>
<body name='d' pos='6 0 1'><joint name='ball' type='ball'/><geom name='q' size='0.1'/></body>
<body name='e' pos='9 0 1'><freejoint/><geom type='mesh' mesh=')" +
         (row.tag() == "mesh" && row.path[1] == "asset" ? "new" : "tetra") + "'/></body>" + own +
         R"(</worldbody><tendon><fixed name='t' limited='true' range='-1 1'><joint joint='j' coef='1'/></fixed></tendon>
<actuator><motor name='m' joint='j'/></actuator>)" +
         (is_section ? planted_element : "") + "</mujoco>";
}

ImportedWorld imported(const std::string& text) {
  ImportInput input;
  input.text = text;
  return import_mjcf(input);
}

/// How many of each kind are listed.
std::map<std::string, std::size_t> listed(const ImportedWorld& world) {
  std::map<std::string, std::size_t> out;
  for (const LeftOut& one : world.left_out) out[one.what] += one.count;
  return out;
}

bool lists_more(const ImportedWorld& with, const ImportedWorld& without) {
  const auto before = listed(without);
  for (const auto& [what, count] : listed(with)) {
    const auto found = before.find(what);
    if (found == before.end() || found->second < count) return true;
  }
  return false;
}

std::string needed_by(const Row& row) {
  if (const auto own = kNeeded.find(row.path[1] + "/" + row.tag()); own != kNeeded.end()) {
    return own->second;
  }
  if (const auto own = kNeeded.find(row.tag()); own != kNeeded.end()) return own->second;
  std::string out;
  if (row.path[1] != "sensor" && row.path[1] != "actuator") return out;
  for (const auto& attribute : row.attributes) {
    if (row.path[1] == "actuator" && attribute != "joint") continue;
    const auto reference = kReferences.find(attribute);
    if (reference != kReferences.end()) out += attribute + "='" + reference->second + "' ";
  }
  return out;
}

/// The facts of a world, as text.
std::string facts(const ImportedWorld& world) {
  std::ostringstream out;
  for (const ImportedBody& body : world.bodies) {
    const BodySpec& s = body.spec;
    out << s.name << " " << s.p_WB.transpose() << " " << s.yaw_rad << " " << s.mass_kg << " "
        << s.material << " " << s.apart;
    if (s.inertia) out << " " << s.inertia->p_BC.transpose() << " " << s.inertia->I_C_kg_m2;
    for (const BodyShape& shape : s.shapes) {
      out << " shape " << static_cast<int>(shape.form) << " " << shape.size_m.transpose() << " "
          << shape.p_BS.transpose() << " " << shape_rotation(shape);
    }
    for (const auto& [shape, corners] : body.hulls) {
      for (const auto& corner : corners) out << " corner " << corner.transpose();
    }
    out << "\n";
  }
  for (const ImportedJoint& joint : world.joints) {
    const JointSpec& s = joint.spec;
    out << s.name << static_cast<int>(s.type) << " " << s.axis_W.transpose() << " "
        << s.p_WA.transpose() << " " << s.low_rad.value_or(9) << " " << s.high_rad.value_or(9)
        << " " << s.low_m.value_or(9) << " " << s.high_m.value_or(9) << " " << s.damping_nm_s << " "
        << s.max_torque_nm << " " << s.max_force_n << "\n";
  }
  out << world.gravity_m_s2.value_or(0.0);
  return out.str();
}

/// Elements that are listed, or refused, with all that is in them.
bool is_listed_whole(const Row& row) {
  static const std::set<std::string> kSections =
      words_of("size visual statistic custom equality tendon actuator sensor keyframe");
  static const std::set<std::string> kElements =
      words_of("lengthrange texture hfield skin material site camera light composite pair");
  return std::any_of(row.path.begin() + 1, row.path.end(), [](const std::string& tag) {
    return kSections.contains(tag) || kElements.contains(tag);
  });
}

TEST_CASE("every element of MuJoCo's schema is taken over, listed with all in it, or refused") {
  if (skips_mjcf()) return;
  const ImportedWorld without = imported(file_having({{"mujoco"}, {}}, ""));
  REQUIRE_MESSAGE(!without.fault, without.fault->message);
  std::size_t count = 0;
  for (const Row& row : schema()) {
    // Classes apply to what is listed itself; parts of a section are listed with it.
    if (row.path.size() < 2 || row.path[1] == "default" || !is_listed_whole(row)) continue;
    const bool holds_more = row.path.size() == 2 && words_of(
                                                        "custom equality tendon actuator "
                                                        "sensor keyframe")
                                                        .contains(row.tag());
    const std::set<std::string> parents = words_of("tuple skin spatial fixed composite visual");
    if (holds_more || (row.path.size() > 2 && parents.contains(row.path[row.path.size() - 2]))) {
      continue;
    }
    const std::string text = file_having(row, needed_by(row));
    CAPTURE(text);
    const ImportedWorld world = imported(text);
    if (row.tag() == "composite" || row.tag() == "distance") {  // MuJoCo itself refuses that
      CHECK(world.fault.has_value());
    } else {
      CHECK_MESSAGE(!world.fault, world.fault->message);
      CHECK(lists_more(world, without));
    }
    ++count;
  }
  CHECK(count > 60);
}

TEST_CASE("every attribute of what is taken over is, or it is listed") {
  if (skips_mjcf()) return;
  std::size_t listed_count = 0;
  for (const Row& row : schema()) {
    const bool is_class = row.path.size() > 2 && row.path[1] == "default";
    if (is_class && !words_of("mesh joint geom").contains(row.tag())) continue;
    if (is_listed_whole(row) && row.path.size() > 1) continue;
    const auto taken = kTakenOver.find(row.tag());
    const std::set<std::string> over =
        taken == kTakenOver.end() ? std::set<std::string>() : words_of(taken->second);
    const auto needed = kNeeded.find(row.tag());
    const ImportedWorld without =
        imported(file_having(row, needed == kNeeded.end() || is_class ? "" : needed->second));
    REQUIRE_MESSAGE(!without.fault, without.fault->message);
    for (const std::string& attribute : row.attributes) {
      const bool is_taken = over.contains(attribute);
      if (is_taken &&
          (is_class || !words_of("body inertial joint geom mesh").contains(row.tag()))) {
        continue;
      }
      const bool is_own = words_of("file mesh vertex face").contains(attribute) ||
                          (row.tag() == "mesh" && attribute == "name");
      if (is_taken && is_own) continue;
      const std::string text =
          file_having(row, is_class ? in_class(attribute) : planted(row.tag(), attribute));
      CAPTURE(text);
      CAPTURE(attribute);
      const ImportedWorld world = imported(text);
      if (is_class && attribute == "hfield") {  // not all geoms can be one
        CHECK(world.fault.has_value());
        continue;
      }
      CHECK_MESSAGE(!world.fault, world.fault->message);
      if (const auto named = kListedByName.find(attribute); named != kListedByName.end()) {
        CHECK(listed(world).contains(named->second));
      } else if (is_taken) {
        CHECK((facts(world) != facts(without) || attribute == "name"));
      } else {
        CHECK(lists_more(world, without));
        ++listed_count;
      }
    }
  }
  CHECK(listed_count > 60);
}

TEST_CASE("what an included file has is listed at its include, and defaults say nothing") {
  if (skips_mjcf()) return;
  Workspace workspace;
  std::filesystem::create_directories(workspace.folder() / "models");
  workspace.write("models/part.xml",
                  "<mujoco><worldbody><body name='b' pos='0 0 1' user='1'>"
                  "<joint margin='0' group='0'/><geom name='part' size='0.1' "
                  "fluidshape='none' group='0'/></body></worldbody></mujoco>");
  CHECK(taken_over(workspace, file_with("<include file='part.xml'/>")).has_value());
  CHECK(workspace.reports() ==
        std::vector<std::string>{"W5144 at 2:1: not taken over, 1 of them: attributes `user` of "
                                 "<body>; the first is `b`"});
}

TEST_CASE("a free joint's damping, spring and armature are listed, with what a class says of it") {
  if (skips_mjcf()) return;
  const auto said = [](const std::string& joint) {
    return listed(
        imported("<mujoco><default><joint stiffness='2'/></default><worldbody>"
                 "<body pos='0 0 1'>" +
                 joint + "<geom size='0.1'/></body></worldbody></mujoco>"));
  };
  CHECK(said("<joint type='free' damping='1' armature='0.1'/>") ==
        std::map<std::string, std::size_t>{{"damping and friction of free joints", 1},
                                           {"springs of joints", 1},
                                           {"inertia of what drives joints (armature)", 1}});
  CHECK(said("<freejoint/>").empty());
}

}  // namespace
}  // namespace parallax::harness::test
