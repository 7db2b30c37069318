#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/import/xml_outline.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

/// A file of another format, and where to look for what it names.
struct ImportInput {
  std::string text;
  /// Folders in which `model://NAME` is looked for, the first first. Nothing else is opened.
  std::vector<std::filesystem::path> folders;
  std::map<std::string, std::filesystem::path> packages = {};  // folders of single ones, by name
  Eigen::Vector3d p_WI = Eigen::Vector3d::Zero();              // where its origin is put [m]
  double yaw_rad = 0.0;
  bool fixed = false;                            // a robot's root to the world
  std::map<std::string, double> positions = {};  // of joints at first, by plain name [rad, m]
  std::filesystem::path folder = {};             // of the file
  /// May a file be read, when it lies in one of the folders? Empty: it may.
  std::function<bool(const std::filesystem::path& path)> admits = {};
  /// The file of a mesh that is named so in the description at `from` (empty: in `text`); none
  /// where it is not to be had.
  std::function<std::optional<std::string>(const std::string& uri, const std::string& from)>
      find_mesh = {};
  const std::atomic<bool>* stop = nullptr;  // ends processes that read it (limited_child.h)
};

/// A mesh in the place of a shape, whose pose is that of the mesh.
struct MeshUse {
  std::string file;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

/// Places are offsets in ImportInput::text.
struct ImportedBody {
  BodySpec spec;
  std::size_t offset = 0;
  std::map<std::size_t, MeshUse> meshes = {};                      // by the number of the shape
  std::map<std::size_t, std::vector<Eigen::Vector3d>> hulls = {};  // corners, likewise
};
struct ImportedJoint {
  JointSpec spec;
  std::size_t offset = 0;
};

/// Elements of one kind that are in the file but not in the world.
struct LeftOut {
  std::string what;  // "sensors"
  std::size_t count = 0;
  std::string first;  // name of the first one
  std::size_t offset = 0;
};

struct ImportedWorld {
  std::optional<TextFault> fault;  // then the rest says nothing
  std::vector<ImportedBody> bodies;
  std::vector<ImportedJoint> joints;
  FrictionSpec friction;       // of the materials that the file makes
  std::string floor_material;  // if the file has a floor
  std::optional<double> gravity_m_s2;
  std::vector<LeftOut> left_out;
  std::vector<std::string> files;        // that were read besides
  std::vector<std::string> absent = {};  // paths where a file was sought and not found
};

/// Was the library that reads the format there when this was built?
bool reads_sdf();
bool reads_urdf();
bool reads_mjcf();

/// Hands only texts that `outline_of` lets pass to the library, whose own messages are kept back.
/// Not to be called by two threads at once.
ImportedWorld import_sdf(const ImportInput& input);
ImportedWorld import_urdf(const ImportInput& input);
ImportedWorld import_mjcf(const ImportInput& input);

}  // namespace parallax::harness
