// Files that worlds in MJCF name: found where they may be, else refused at their place; nothing is
// opened that is not vetted.

#include <sys/stat.h>

#include "harness/import/mesh.h"
#include "tests/harness/config/mjcf_text.h"

namespace parallax::harness::test {
namespace {

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
  // Beside the description it was looked for first.
  const auto beside = std::filesystem::canonical(workspace.folder()) / "shared/three.xml";
  CHECK(std::any_of(read.begin(), read.end(), [&](const auto& one) { return one == beside; }));
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
  REQUIRE(reports.size() == 5);
  for (const char* kind : {"3 of them: pictures (textures); the first is `pipe.png`",
                           "1 of them: skins; the first is `s`", "2 of them: height fields"}) {
    CHECK_MESSAGE(std::any_of(reports.begin(), reports.end(),
                              [&](const auto& one) { return one.find(kind) != one.npos; }),
                  kind);
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

TEST_CASE("what a hull adds to a mesh of MJCF is said once for the mesh") {
  if (skips_mjcf() || !reads_meshes()) return;
  Workspace workspace;
  // An L of three cubes, which its hull fills by half a cube more.
  workspace.write("ell.obj",
                  "v 0 0 0\nv .2 0 0\nv .2 .1 0\nv .1 .1 0\nv .1 .2 0\nv 0 .2 0\n"
                  "v 0 0 .1\nv .2 0 .1\nv .2 .1 .1\nv .1 .1 .1\nv .1 .2 .1\nv 0 .2 .1\n"
                  "f 1 4 3\nf 1 3 2\nf 1 6 5\nf 1 5 4\nf 7 9 10\nf 7 8 9\nf 7 11 12\nf 7 10 11\n"
                  "f 1 2 8\nf 1 8 7\nf 2 3 9\nf 2 9 8\nf 3 4 10\nf 3 10 9\nf 4 5 11\nf 4 11 10\n"
                  "f 5 6 12\nf 5 12 11\nf 6 1 7\nf 6 7 12\n");
  const auto ell = [](const char* name, double x) {
    return "<body name='" + std::string(name) + "' pos='" + std::to_string(x) +
           " 0 1'><freejoint/><geom type='mesh' mesh='ell' mass='1'/></body>\n";
  };
  const auto scenario =
      taken_over(workspace, file_with("<asset><mesh file='ell.obj'/></asset><worldbody>\n" +
                                      ell("a", 1) + ell("b", 3) + "</worldbody>"));
  REQUIRE(scenario.has_value());
  CHECK(workspace.reports() ==
        std::vector<std::string>{
            "W5144 at 3:47: not taken over, 1 of them: hollows of meshes, which "
            "become their convex hull; the first is `ell: 1.17 times its volume`"});
  for (const char* name : {"a", "b"}) {
    CHECK(body(scenario->world, name).shapes.front().hull->volume_m3 == doctest::Approx(0.0035));
  }
}

TEST_CASE(
    "what is wrong with a mesh of MJCF is told with the name of its file in the description") {
  if (skips_mjcf()) return;
  std::string lying(84, ' ');  // binary STL with more faces than there may be
  lying.replace(80, 4, "\xff\xff\xff\x7f");
  Workspace workspace;
  std::filesystem::create_directories(workspace.folder() / "parts/deep");
  workspace.write("parts/fine.obj", kTetrahedron);
  workspace.write("parts/deep/lying.stl", lying);
  for (const char* empty : {"empty.obj", "empty.stl", "empty.msh"}) {
    workspace.write(std::string("parts/") + empty, "");
  }
  // The bad one is the twelfth file: names of our own must not be taken for how others begin.
  const auto with = [&](const std::string& file) {
    std::string meshes;
    for (int i = 1; i < 12; ++i) {
      const std::string name = "fine" + std::to_string(i) + ".obj";
      workspace.write("parts/" + name, kTetrahedron);
      meshes += "<mesh file='" + name + "'/>\n";
    }
    return "<mujoco>\n<compiler meshdir='parts'/><asset>\n" + meshes + "<mesh name='bad' file='" +
           file + "'/></asset>\n<worldbody><geom type='mesh' mesh='bad'/></worldbody></mujoco>";
  };
  for (const std::string empty : {"empty.obj", "empty.stl", "empty.msh"}) {
    CHECK(refusal_of(workspace, with(empty)) ==
          "E5143 at 14:1: the file cannot be taken over: `" + empty + "` is empty");
  }
  const auto said = refusal_of(workspace, with("deep/lying.stl"));
  CHECK(said.starts_with("E5143 at 14:1: the file cannot be taken over: number of faces"));
  CHECK(said.find("'deep/lying.stl'") != said.npos);
  CHECK(said.find("file_of_mesh") == said.npos);
  // At the mesh, also where its line begins with something else.
  CHECK(refusal_of(workspace,
                   "<mujoco>\n<asset><mesh name='bad' "
                   "file='parts/deep/lying.stl'/></asset>\n<worldbody>"
                   "<geom type='mesh' mesh='bad'/></worldbody></mujoco>")
            .starts_with("E5143 at 2:8: the file cannot be taken over: number of faces"));
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

}  // namespace
}  // namespace parallax::harness::test
