#pragma once

#include "harness/import/mesh.h"

namespace parallax::harness {

// Assimp and Qhull are in a module that is loaded where a world has a mesh or a hull, as the reader
// of SDF is (sdf_module.h).

inline constexpr const char* kMeshModule = "parallax_mesh.so";
inline constexpr const char* kMeshFunctions = "parallax_mesh_functions";

struct HullFaces {
  std::optional<std::string> fault;
  std::vector<Eigen::Vector3d> corners;  // those of the points that are corners, in their order
  std::vector<std::array<std::uint32_t, 3>> faces;
};

struct MeshFunctions {
  MeshCorners (*read)(const std::string& text, const std::string& extension,
                      const Eigen::Vector3d& scale);
  HullFaces (*hull)(const std::vector<Eigen::Vector3d>& points);
};

/// The module's only function. Null where `version` is not its own.
using GetMeshFunctions = const MeshFunctions*(const char* version);

}  // namespace parallax::harness
