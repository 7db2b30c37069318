#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/world/convex_hull.h"

namespace parallax::harness {

inline constexpr std::size_t kMaxMeshBytes = 32U << 20;
inline constexpr std::size_t kMaxMeshFaces = 300'000;
/// A hull with more corners is replaced by one with this number of its corners.
inline constexpr std::size_t kMaxMeshCorners = 64;

/// Corners of the convex hull of all that is in the file, in its frame. `extension` says the
/// format.
struct MeshCorners {
  std::optional<std::string> fault;  // then the rest says nothing; reads after "the mesh ..."
  std::vector<Eigen::Vector3d> corners;
  std::size_t faces = 0;         // of the mesh
  std::size_t hull_corners = 0;  // before some were left out
  double off = 0.0;              // by which the corners that were left out stand outside
  double volume = 0.0;           // of the mesh, where it is closed; else 0
  double hull_volume = 0.0;
  bool is_open = false;  // its faces close nothing in
};

/// A notable addition of a hull to its mesh, or a loss from it.
struct MeshLoss {
  std::string what;  // a kind, as LeftOut's
  std::string of;    // which mesh, and how much
};
std::vector<MeshLoss> losses_of(const MeshCorners& made, const std::string& name);

/// A hull of points, whose origin is `middle`.
struct MadeHull {
  std::optional<std::string> fault;
  std::shared_ptr<const ConvexHull> hull;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
};

/// stl, obj, dae or ply.
bool is_mesh_format(const std::filesystem::path& path);

/// Is the module there that reads meshes and makes hulls?
bool reads_meshes();

/// The file is read in a process of its own, with limits: what the library makes of a hostile one
/// does no harm here. `stop` ends it early (limited_child.h).
MeshCorners mesh_corners(const std::string& text, const std::string& extension,
                         const Eigen::Vector3d& scale, const std::atomic<bool>* stop = nullptr);
MadeHull hull_of(const std::vector<Eigen::Vector3d>& points);

}  // namespace parallax::harness
