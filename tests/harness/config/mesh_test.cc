// Meshes from their files to hulls in a world, and files that are not meshes.

#include "harness/import/mesh.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <numbers>

#include "harness/import/import.h"
#include "tests/harness/config/scenario_text.h"

namespace parallax::harness::test {
namespace {

bool no_meshes() {
  if (reads_meshes()) return false;
  std::cout << "SKIPPED: this build reads no meshes\n";
  return true;
}

struct Mesh {
  std::vector<std::array<double, 3>> corners;
  std::vector<std::array<std::size_t, 3>> faces;
};

/// A body of revolution round z; the outline closes itself.
Mesh lathed(const std::vector<std::array<double, 2>>& outline, std::size_t sides) {
  Mesh mesh;
  for (std::size_t k = 0; k < sides; ++k) {
    const double angle =
        2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(sides);
    for (const auto& [r, z] : outline) {
      mesh.corners.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
  }
  const std::size_t n = outline.size();
  for (std::size_t k = 0; k < sides; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t next = (k + 1) % sides, up = (i + 1) % n;
      mesh.faces.push_back({k * n + i, next * n + i, next * n + up});
      mesh.faces.push_back({k * n + i, next * n + up, k * n + up});
    }
  }
  return mesh;
}

Mesh box_mesh(double x, double y, double z) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.corners.push_back(
        {(i & 1) != 0 ? x : 0.0, (i & 2) != 0 ? y : 0.0, (i & 4) != 0 ? z : 0.0});
  }
  mesh.faces = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

std::string as_obj(const Mesh& mesh) {
  std::string text = "mtllib nothing.mtl\n";
  for (const auto& [x, y, z] : mesh.corners) {
    text += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
  }
  for (const auto& [a, b, c] : mesh.faces) {
    text += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " +
            std::to_string(c + 1) + "\n";
  }
  return text;
}

std::string as_stl(const Mesh& mesh) {
  std::string text(80, '\0');
  const auto put = [&](const auto& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  put(static_cast<std::uint32_t>(mesh.faces.size()));
  for (const auto& face : mesh.faces) {
    for (int i = 0; i < 3; ++i) put(0.0F);
    for (const auto corner : face) {
      for (const double x : mesh.corners[corner]) put(static_cast<float>(x));
    }
    put(std::uint16_t{0});
  }
  return text;
}

std::string as_dae(const Mesh& mesh, const std::string& inside = {}) {
  std::string places, indices;
  for (const auto& corner : mesh.corners) {
    for (const double x : corner) places += std::to_string(x) + " ";
  }
  for (const auto& face : mesh.faces) {
    for (const auto corner : face) indices += std::to_string(corner) + " ";
  }
  const auto count = std::to_string(mesh.corners.size());
  return "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\"><asset><up_axis>Z_UP</up_axis></asset><library_geometries><geometry "
         "id=\"g\"><mesh><source id=\"s\"><float_array id=\"a\" count=\"" +
         std::to_string(3 * mesh.corners.size()) + "\">" + places +
         "</float_array><technique_common><accessor source=\"#a\" count=\"" + count +
         "\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>"
         "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
         "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#s\"/></vertices>"
         "<triangles count=\"" +
         std::to_string(mesh.faces.size()) +
         "\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>" + indices +
         "</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>"
         "<visual_scene id=\"scene\">" +
         inside +
         "<node id=\"n\"><instance_geometry url=\"#g\"/></node></visual_scene>"
         "</library_visual_scenes><scene><instance_visual_scene url=\"#scene\"/></scene></COLLADA>";
}

std::string world_with(const std::string& bodies) {
  return "model: domain.e\nhorizon: 2\nworld:\n  bodies:\n" + bodies +
         "    cup: {size_m: [0.1, 0.1, 0.1], mass_kg: 0.2, position_m: [5, 5, 0.05]}\n" + R"(
regions: {gaps: allowed, cells: {here: {x: [0, 1]}}}
mapping: {At(region): {inside: region, body: cup, drawn: false}}
actions: {}
)";
}

const BodySpec& body_of(const Scenario& scenario, const std::string& name) {
  const auto& bodies = scenario.world.bodies;
  const auto found = std::find_if(bodies.begin(), bodies.end(),
                                  [&](const BodySpec& one) { return one.name == name; });
  REQUIRE_MESSAGE(found != bodies.end(), name);
  return *found;
}

TEST_CASE("a mesh in any format becomes the convex hull of its corners, scaled and turned") {
  if (no_meshes()) return;
  const Mesh box = box_mesh(0.2, 0.4, 0.6);
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"box.obj", as_obj(box)}, {"box.stl", as_stl(box)}, {"box.dae", as_dae(box)}}) {
    CAPTURE(name);
    Workspace workspace;
    workspace.write(name, text);
    const auto scenario = workspace.load(world_with(
        "    plain: {mesh: " + name + ", mass_kg: 1, position_m: [0, 0, 1]}\n" +
        "    parts: {shapes: [{mesh: {file: " + name +
        ", scale: 0.5}, at_m: [1, 0, 0], yaw_rad: 1.5707963267948966}, {size_m: [1, 1, 1]}], "
        "position_m: [3, 0, 1]}\n" +
        "    wide: {mesh: {file: " + name + ", scale: [2, 1, 1]}, position_m: [0, 3, 1]}\n"));
    for (const auto& one : workspace.reports()) CAPTURE(one);
    REQUIRE(scenario.has_value());
    CHECK(workspace.reports().empty());
    const BodyShape& plain = body_of(*scenario, "plain").shapes.front();
    CHECK(plain.form == ShapeForm::kHull);
    CHECK(plain.hull->vertices.size() == 8);
    CHECK(plain.hull->volume_m3 == doctest::Approx(0.2 * 0.4 * 0.6));
    // The mesh begins at its own origin, which stays where it is in the body.
    CHECK((plain.p_BS - Eigen::Vector3d(0.1, 0.2, 0.3)).norm() < 1e-6);
    const BodyShape& part = body_of(*scenario, "parts").shapes.front();
    CHECK((part.p_BS - Eigen::Vector3d(1.0 - 0.1, 0.05, 0.15)).norm() < 1e-6);
    CHECK((part.size_m - Eigen::Vector3d(0.1, 0.2, 0.3)).norm() < 1e-6);
    CHECK(
        (body_of(*scenario, "wide").shapes.front().size_m - Eigen::Vector3d(0.4, 0.4, 0.6)).norm() <
        1e-6);
  }
}

TEST_CASE("what a hull adds to a mesh, and what it loses of it, is said") {
  if (no_meshes()) return;
  Workspace workspace;
  workspace.write(
      "bowl.stl",
      as_stl(lathed(
          {{0.0, 0.0}, {0.04, 0.0}, {0.04, 0.1}, {0.036, 0.1}, {0.036, 0.004}, {0.0, 0.004}}, 24)));
  std::vector<std::array<double, 2>> half_circle;
  for (int i = 0; i <= 40; ++i) {
    const double angle = std::numbers::pi * (i / 40.0 - 0.5);
    half_circle.push_back({0.5 * std::cos(angle), 0.5 * std::sin(angle)});
  }
  workspace.write("ball.stl", as_stl(lathed(half_circle, 40)));
  const auto scenario =
      workspace.load(world_with("    bowl: {mesh: bowl.stl, mass_kg: 0.3, position_m: [1, 0, 0]}\n"
                                "    other: {mesh: bowl.stl, mass_kg: 0.3, position_m: [2, 0, 0]}\n"
                                "    ball: {mesh: ball.stl, position_m: [3, 0, 1]}\n"));
  REQUIRE(scenario.has_value());
  const auto reports = workspace.reports();
  REQUIRE(reports.size() == 2);
  CAPTURE(reports[0]);
  CAPTURE(reports[1]);
  CHECK(
      reports[1].starts_with("W5144 at 7:18: not taken over, 1 of them: corners of hulls that have "
                             "more than 64; the first is `ball.stl: up to "));
  CHECK(
      reports[0].starts_with("W5144 at 5:18: not taken over, 1 of them: hollows of meshes, which "
                             "become their convex hull; "
                             "the first is `bowl.stl: 4."));
  const ConvexHull& bowl = *body_of(*scenario, "bowl").shapes.front().hull;
  CHECK(bowl.vertices.size() == 48);
  // A prism of 24 sides.
  CHECK(bowl.volume_m3 ==
        doctest::Approx(0.5 * 24 * 0.04 * 0.04 * std::sin(2 * std::numbers::pi / 24) * 0.1));
  const ConvexHull& ball = *body_of(*scenario, "ball").shapes.front().hull;
  CHECK(ball.vertices.size() == kMaxMeshCorners);
  CHECK((ball.size_m - Eigen::Vector3d::Constant(1.0)).norm() < 0.01);  // its box is kept
  CHECK(ball.volume_m3 > 0.85 * 4.0 / 3.0 * std::numbers::pi * 0.125);
  // The same file gives the same bits.
  Workspace again;
  again.write("ball.stl", as_stl(lathed(half_circle, 40)));
  const auto second = again.load(world_with("    ball: {mesh: ball.stl, position_m: [3, 0, 1]}\n"));
  REQUIRE(second.has_value());
  CHECK(body_of(*second, "ball").shapes.front().hull->vertices == ball.vertices);
  CHECK(body_of(*second, "ball").shapes.front().hull->faces == ball.faces);
}

TEST_CASE("corners may be written down, and what they cannot be is said at its place") {
  if (no_meshes()) return;
  const auto report_of = [](const std::string& form) {
    Workspace workspace;
    const auto scenario =
        workspace.load(world_with("    odd: {" + form + ", position_m: [0, 0, 2]}\n"));
    const auto reports = workspace.reports();
    return scenario ? std::string("taken") : reports.front();
  };
  const std::string wedge = "hull: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]";
  CHECK(report_of(wedge) == "taken");
  CHECK(report_of("shapes: [{" + wedge + ", at_m: [0, 0, 0.5]}]") == "taken");
  CHECK(report_of(wedge + ", size_m: [1, 1, 1]").starts_with("E5"));
  CHECK(report_of("hull: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]") ==
        "E5143 at 5:11: the file cannot be taken over: the hull is flat: it has no volume");
  CHECK(report_of("hull: [[0, 0, 0]]").starts_with("E5143 at 5:"));
  CHECK(report_of("hull: [[0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]").starts_with("E5143 at 5:"));
  CHECK(report_of("hull: [[0, 0, x], [1, 0, 0], [0, 1, 0], [0, 0, 1]]").starts_with("E5"));
  CHECK(report_of("hull: [[0, 0, 1e9], [1, 0, 0], [0, 1, 0], [0, 0, 1]]").starts_with("E5"));
  CHECK(report_of("hull: 3").starts_with("E5143 at 5:"));
  CHECK(report_of("mesh: 3").starts_with("E5"));
  CHECK(report_of("mesh: {scale: 2}").starts_with("E5"));
  CHECK(report_of("mesh: {file: a.stl, scale: -1}").starts_with("E5"));
  CHECK(report_of("mesh: {file: a.stl, scale: [1, 0, 1]}").starts_with("E5143"));
  CHECK(report_of("mesh: {file: a.stl, skale: 1}").starts_with("E5"));
}

TEST_CASE("hostile meshes are refused in one line at their place, and nothing of them lasts") {
  if (no_meshes()) return;
  const Mesh box = box_mesh(1.0, 1.0, 1.0);
  Mesh odd = box;
  odd.corners[3][1] = std::numeric_limits<double>::quiet_NaN();
  Mesh flat = box_mesh(1.0, 1.0, 0.0);
  std::string deep, entities = "<!DOCTYPE l [<!ENTITY a0 \"aaaaaaaaaa\">";
  for (int i = 0; i < 200000; ++i) deep += "<node>";
  for (int i = 0; i < 200000; ++i) deep += "</node>";
  for (int i = 1; i < 10; ++i) {
    entities += "<!ENTITY a" + std::to_string(i) + " \"";
    for (int k = 0; k < 10; ++k) entities += "&a" + std::to_string(i - 1) + ";";
    entities += "\">";
  }
  std::string lie(80, '\0');
  lie += "\xff\xff\xff\xff";
  lie += std::string(50, '\0');
  Mesh many;
  many.corners = box.corners;
  for (std::size_t i = 0; i < 26000; ++i) {
    many.faces.insert(many.faces.end(), box.faces.begin(), box.faces.end());
  }
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"empty.stl", ""},
           {"noise.stl", std::string(5000, '\x93')},
           {"noise.dae", std::string(5000, '\x93')},
           {"noise.obj", std::string(5000, '\x93')},
           {"lie.stl", lie},
           {"odd.stl", as_stl(odd)},
           {"flat.stl", as_stl(flat)},
           {"many.stl", as_stl(many)},
           {"deep.dae", as_dae(box, deep)},
           {"bomb.dae", "<?xml version=\"1.0\"?>" + entities + "]><COLLADA>&a9;</COLLADA>"},
           {"bad.obj", "v 0 0 0\nv 1 0 0\nf 1 2 99999999\n"},
           {"short.stl", as_stl(box).substr(0, 300)},
       }) {
    CAPTURE(name);
    Workspace workspace;
    workspace.write(name, text);
    CHECK_FALSE(workspace.load(world_with("    odd: {mesh: " + name + ", position_m: [0, 0, 2]}\n"))
                    .has_value());
    const auto reports = workspace.reports();
    REQUIRE_FALSE(reports.empty());
    CHECK(reports.front().starts_with("E5143 at 5:17: the file cannot be taken over: the mesh `" +
                                      name + "` "));
    CHECK(workspace.sink.exit_code() == 3);
  }
}

TEST_CASE("random damage to a mesh is a fault or a hull, never more") {
  if (no_meshes()) return;
  const Mesh cone = lathed({{0.0, 0.0}, {0.3, 0.0}, {0.1, 0.5}, {0.0, 0.5}}, 12);
  std::uint64_t random = 88172645463325252U;
  const auto next = [&](std::size_t below) {
    random ^= random << 13U;
    random ^= random >> 7U;
    random ^= random << 17U;
    return static_cast<std::size_t>(random % below);
  };
  for (const auto& [extension, good] : std::vector<std::pair<std::string, std::string>>{
           {"obj", as_obj(cone)}, {"stl", as_stl(cone)}, {"dae", as_dae(cone)}}) {
    for (int turn = 0; turn < 60; ++turn) {
      std::string text = good;
      for (std::size_t i = 0, count = 1 + next(8); i < count; ++i) {
        text[next(text.size())] = static_cast<char>(next(256));
      }
      if (turn % 3 == 0) text.erase(next(text.size()));
      const MeshCorners made = mesh_corners(text, extension, Eigen::Vector3d::Ones());
      if (made.fault) {
        CHECK_FALSE(made.fault->empty());
        continue;
      }
      CHECK(made.corners.size() <= kMaxMeshCorners);
      const MadeHull hull = hull_of(made.corners);
      CHECK((hull.fault.has_value() || hull.hull->volume_m3 > 0.0));
    }
  }
}

TEST_CASE("meshes are read only where files may be named, and only what is a mesh") {
  if (no_meshes()) return;
  Workspace workspace;
  workspace.write("box.stl", as_stl(box_mesh(1.0, 1.0, 1.0)));
  std::filesystem::create_symlink("/etc/passwd", workspace.folder() / "out.stl");
  std::filesystem::create_directory(workspace.folder() / "folder.stl");
  workspace.write("long.stl", "");
  REQUIRE(::truncate((workspace.folder() / "long.stl").c_str(), 33 << 20) == 0);
  workspace.write("box.blend", "BLENDER");
  for (const auto& [name, code] : std::vector<std::pair<std::string, std::string>>{
           {"../../etc/x.stl", "E1016"},
           {"/etc/x.stl", "E1016"},
           {"out.stl", "E1016"},
           {"nothing.stl", "E"},
           {"folder.stl", "E"},
           {"long.stl",
            "E5143 at 5:17: the file cannot be taken over: `long.stl` is longer than 32"},
           {"box.blend", "E5143 at 5:17: the file cannot be taken over: `box.blend` is none of"}}) {
    CAPTURE(name);
    CHECK_FALSE(workspace.load(world_with("    odd: {mesh: " + name + ", position_m: [0, 0, 2]}\n"))
                    .has_value());
    const auto reports = workspace.reports();
    REQUIRE_FALSE(reports.empty());
    CHECK(reports.front().starts_with(code));
    CHECK(workspace.sink.exit_code() >= 2);
  }
}

TEST_CASE("meshes of robots and worlds in other formats are found in folders that are given") {
  if (no_meshes()) return;
  const auto scenario_of = [](const std::string& world) {
    return "model: domain.e\nhorizon: 2\nworld:\n" + world +
           "  bodies: {cup: {size_m: [0.1, 0.1, 0.1], mass_kg: 0.2, position_m: [5, 5, 0.05]}}\n" +
           "regions: {gaps: allowed, cells: {here: {x: [0, 1]}}}\n"
           "mapping: {At(region): {inside: region, body: cup, drawn: false}}\nactions: {}\n";
  };
  const auto urdf = [](const std::string& file) {
    return "<robot name='r'><link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' "
           "izz='1' "
           "ixy='0' ixz='0' iyz='0'/></inertial>\n<collision><origin xyz='0 0 0.5'/><geometry>"
           "<mesh filename='" +
           file + "' scale='0.001 0.001 0.001'/></geometry></collision></link></robot>";
  };
  const auto sdf = [](const std::string& file) {
    return "<?xml version='1.0'?>\n<sdf version='1.9'><model name='a'><static>true</static><link "
           "name='l'><collision name='c'><pose>0 0 0.5 0 0 0</pose><geometry><mesh><uri>" +
           file +
           "</uri><scale>0.001 0.001 "
           "0.001</scale></mesh></geometry></collision></link></model></sdf>";
  };
  const std::string mesh = as_stl(box_mesh(200.0, 200.0, 200.0));
  for (const bool is_sdf : {false, true}) {
    if (!(is_sdf ? reads_sdf() : reads_urdf())) continue;
    const std::string file = is_sdf ? "a.sdf" : "a.urdf";
    const std::string world = (is_sdf ? "  sdf: a.sdf\n" : "  urdf: a.urdf\n") +
                              std::string("  models: [first, second]\n");
    const std::string scheme = is_sdf ? "model://" : "package://";
    for (const auto& [uri, is_found] :
         std::vector<std::pair<std::string, bool>>{{scheme + "thing/meshes/box.stl", true},
                                                   {"meshes/box.stl", true},
                                                   {scheme + "thing/meshes/none.stl", false},
                                                   {scheme + "../secret/box.stl", false},
                                                   {"../secret/box.stl", false},
                                                   {"file:///etc/box.stl", false},
                                                   {"/etc/box.stl", false},
                                                   {scheme + "thing/meshes/box.blend", false}}) {
      CAPTURE(uri);
      Workspace workspace;
      std::filesystem::create_directories(workspace.folder() / "first");
      std::filesystem::create_directories(workspace.folder() / "second/thing/meshes");
      std::filesystem::create_directories(workspace.folder() / "meshes");
      workspace.write("second/thing/meshes/box.stl", mesh);
      workspace.write("meshes/box.stl", mesh);
      workspace.write(file, is_sdf ? sdf(uri) : urdf(uri));
      const auto scenario = workspace.load(scenario_of(world));
      for (const auto& one : workspace.reports()) CAPTURE(one);
      REQUIRE((scenario.has_value() || !is_found));
      const auto reports = workspace.reports();
      if (is_found) {
        const BodyShape& shape = body_of(*scenario, "a").shapes.front();
        CHECK(shape.form == ShapeForm::kHull);
        CHECK((shape.size_m - Eigen::Vector3d::Constant(0.2)).norm() < 1e-6);
        CHECK((shape.p_BS - Eigen::Vector3d(0.1, 0.1, 0.6)).norm() < 1e-6);
      } else {
        const bool is_said = std::any_of(reports.begin(), reports.end(), [](const auto& one) {
          return one.find("not taken over, 1 of them: meshes that are not to be had") !=
                 std::string::npos;
        });
        CHECK(is_said);
      }
    }
    // A file that is found and is no mesh is an error at its link.
    Workspace workspace;
    std::filesystem::create_directories(workspace.folder() / "first/thing");
    std::filesystem::create_directories(workspace.folder() / "second");
    workspace.write("first/thing/bad.stl", "no mesh");
    workspace.write(file, is_sdf ? sdf(scheme + "thing/bad.stl") : urdf(scheme + "thing/bad.stl"));
    CHECK_FALSE(workspace.load(scenario_of(world)).has_value());
    CHECK(workspace.reports().front().find("cannot be read") != std::string::npos);
  }
}

}  // namespace
}  // namespace parallax::harness::test
