#include <fmt/format.h>

#include "harness/import/import.h"
#include "harness/import/mesh.h"
#include "tools/doctor/trials.h"

namespace parallax::tools {
namespace {

constexpr const char* kSdf =
    "<?xml version='1.0'?><sdf version='1.7'><world name='w'><model name='crate'>"
    "<pose>0.5 0 0.1 0 0 0</pose><link name='side'><inertial><mass>1</mass></inertial>"
    "<collision name='c'><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>"
    "</link></model></world></sdf>";
constexpr const char* kUrdf =
    "<?xml version='1.0'?><robot name='crate'><link name='side'><inertial><mass value='1'/>"
    "<inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' iyz='0'/></inertial>"
    "<collision><geometry><box size='0.2 0.2 0.2'/></geometry></collision></link></robot>";
constexpr const char* kMjcf =
    "<mujoco><worldbody><body name='crate' pos='0.5 0 0.1'><freejoint/>"
    "<geom type='box' size='0.1 0.1 0.1' mass='1'/></body></worldbody></mujoco>";

CheckUp missing(CheckUp check) {
  check.health = Health::kAbsent;
  check.found = "this program was built without it";
  check.remedy = fmt::format("build again with {} installed", check.package);
  return check;
}

CheckUp judged(CheckUp check, const harness::ImportedWorld& world) {
  if (!world.fault && world.bodies.size() == 1) {
    check.health = Health::kWorks;
    check.found = "read a crate";
    return check;
  }
  check.health = Health::kBroken;
  check.found = world.fault ? "a crate: " + world.fault->message
                            : fmt::format("a crate became {} bodies", world.bodies.size());
  check.remedy = fmt::format("install {} again", check.package);
  return check;
}

}  // namespace

CheckUp try_sdf() {
  CheckUp check{.name = "SDF", .package = "libsdformat-dev", .is_needed = false};
  if (!harness::reads_sdf()) return missing(std::move(check));
  harness::ImportInput input;
  input.text = kSdf;
  return judged(std::move(check), harness::import_sdf(input));
}

CheckUp try_urdf() {
  CheckUp check{.name = "URDF", .package = "liburdfdom-dev", .is_needed = false};
  if (!harness::reads_urdf()) return missing(std::move(check));
  harness::ImportInput input;
  input.text = kUrdf;
  return judged(std::move(check), harness::import_urdf(input));
}

CheckUp try_mjcf() {
  CheckUp check{.name = "MJCF", .package = "libmujoco-dev", .is_needed = false};
  if (!harness::reads_mjcf()) return missing(std::move(check));
  harness::ImportInput input;
  input.text = kMjcf;
  return judged(std::move(check), harness::import_mjcf(input));
}

CheckUp try_meshes() {
  CheckUp check{.name = "meshes", .package = "libassimp-dev and libqhull-dev", .is_needed = false};
  if (!harness::reads_meshes()) return missing(std::move(check));
  const std::string kWedge =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const auto made = harness::mesh_corners(kWedge, "obj", Eigen::Vector3d::Ones());
  const auto hull = made.fault ? harness::MadeHull{} : harness::hull_of(made.corners);
  if (hull.hull != nullptr && hull.hull->vertices.size() == 4) {
    check.health = Health::kWorks;
    check.found = "made the hull of a wedge";
    return check;
  }
  check.health = Health::kBroken;
  check.found = "a wedge: " + made.fault.value_or(hull.fault.value_or("became something else"));
  check.remedy = fmt::format("install {} again", check.package);
  return check;
}

}  // namespace parallax::tools
