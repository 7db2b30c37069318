// The only place of Assimp and Qhull, a module of its own (mesh_module.h).

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string_view>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include "harness/import/mesh_module.h"

namespace parallax::harness {
namespace {

using Face = std::array<std::uint32_t, 3>;

/// One hull of Qhull's, from its making to its end.
class Qhull {
 public:
  explicit Qhull(const std::vector<Eigen::Vector3d>& points)
      : nowhere_(std::fopen("/dev/null", "w")) {
    coordinates_.reserve(3 * points.size());
    for (const auto& p : points) coordinates_.insert(coordinates_.end(), p.data(), p.data() + 3);
    qh_zero(&qh_, nowhere_);
    char options[] = "qhull Qt Pp";
    code_ = qh_new_qhull(&qh_, 3, static_cast<int>(points.size()), coordinates_.data(), False,
                         options, nullptr, nowhere_);
  }
  ~Qhull() {
    qh_freeqhull(&qh_, qh_ALL);
    int left = 0, total = 0;
    qh_memfreeshort(&qh_, &left, &total);
    std::fclose(nowhere_);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;

  bool is_made() const { return code_ == 0; }

  /// By numbers of points, counter-clockwise from outside.
  std::vector<Face> faces() {
    std::vector<Face> out;
    for (facetT* facet = qh_.facet_list; facet != nullptr && facet->next != nullptr;
         facet = facet->next) {
      Face face{};
      std::size_t count = 0;
      for (int i = 0; i < 3; ++i) {
        const auto* vertex = static_cast<const vertexT*>(facet->vertices->e[i].p);
        if (vertex == nullptr) break;
        face[count++] = static_cast<std::uint32_t>(qh_pointid(&qh_, vertex->point));
      }
      if (count != 3) continue;
      if (facet->toporient == 0) std::swap(face[1], face[2]);
      out.push_back(face);
    }
    return out;
  }

 private:
  std::FILE* nowhere_;
  std::vector<double> coordinates_;
  qhT qh_{};
  int code_ = 0;
};

/// Qhull's order is its own; this one is that of the numbers.
void put_in_order(std::vector<Face>& faces) {
  for (Face& face : faces) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  }
  std::sort(faces.begin(), faces.end());
}

HullFaces hull_faces(const std::vector<Eigen::Vector3d>& points) {
  HullFaces out;
  if (points.size() < 4) {
    out.fault = "has fewer than four corners";
    return out;
  }
  Qhull qhull(points);
  if (!qhull.is_made()) {
    out.fault = "is flat: it has no volume";
    return out;
  }
  auto faces = qhull.faces();
  // Which way round Qhull's facets go is told by one that has a direction.
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  std::set<std::uint32_t> used;
  for (const Face& face : faces) used.insert(face.begin(), face.end());
  for (const auto i : used) middle += points[i] / static_cast<double>(used.size());
  double outwards = 0.0;
  for (const Face& face : faces) {
    const Eigen::Vector3d &a = points[face[0]], &b = points[face[1]], &c = points[face[2]];
    outwards += (b - a).cross(c - a).dot(a - middle);
  }
  std::map<std::uint32_t, std::uint32_t> number;
  for (const auto i : used) {
    number.emplace(i, static_cast<std::uint32_t>(out.corners.size()));
    out.corners.push_back(points[i]);
  }
  for (Face face : faces) {
    for (auto& corner : face) corner = number[corner];
    if (outwards < 0.0) std::swap(face[1], face[2]);
    out.faces.push_back(face);
  }
  put_in_order(out.faces);
  return out;
}

double volume_of(const std::vector<Eigen::Vector3d>& points, const std::vector<Face>& faces) {
  double volume = 0.0;
  for (const Face& face : faces) {
    volume += points[face[0]].dot(points[face[1]].cross(points[face[2]])) / 6.0;
  }
  return std::abs(volume);
}

struct Plane {
  Eigen::Vector3d normal;
  double offset = 0.0;
};

std::vector<Plane> planes_of(const HullFaces& hull) {
  std::vector<Plane> planes;
  for (const Face& face : hull.faces) {
    const Eigen::Vector3d &a = hull.corners[face[0]], &b = hull.corners[face[1]],
                          &c = hull.corners[face[2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
    if (normal.allFinite()) planes.push_back({normal, normal.dot(a)});
  }
  return planes;
}

/// The corner that stands out most from the planes, and by how much.
std::pair<std::size_t, double> farthest_of(const std::vector<Eigen::Vector3d>& corners,
                                           const std::vector<Plane>& planes) {
  std::pair<std::size_t, double> found{0, 0.0};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    double out = -std::numeric_limits<double>::infinity();
    for (const Plane& plane : planes) {
      out = std::max(out, plane.normal.dot(corners[i]) - plane.offset);
    }
    if (out > found.second) found = {i, out};
  }
  return found;
}

/// Thins out corners. Keeps those farthest along the axes, so that the bounding box stays the same,
/// and those farthest in `count` evenly spread directions.
std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& corners, int count) {
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::set<std::size_t> kept;
  const auto keep = [&](const Eigen::Vector3d& way) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < corners.size(); ++i) {
      if (corners[i].dot(way) > corners[best].dot(way)) best = i;
    }
    kept.insert(best);
  };
  for (int axis = 0; axis < 3; ++axis) {
    keep(Eigen::Vector3d::Unit(axis));
    keep(-Eigen::Vector3d::Unit(axis));
  }
  for (int k = 0; k < count; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / count, r = std::sqrt(1.0 - z * z);
    keep({r * std::cos(golden * k), r * std::sin(golden * k), z});
  }
  std::vector<Eigen::Vector3d> out;
  for (const auto i : kept) out.push_back(corners[i]);
  return out;
}

/// The corners that lie farthest in a few directions, then again and again the one that stands out
/// most from the hull of those.
std::vector<Eigen::Vector3d> chosen_corners(const std::vector<Eigen::Vector3d>& all, double& off) {
  constexpr std::size_t kMany = 2000;
  constexpr int kAtFirst = 20;
  const auto corners = all.size() > kMany ? thinned(all, static_cast<int>(kMany)) : all;
  std::vector<Eigen::Vector3d> chosen = thinned(corners, kAtFirst);
  while (true) {
    const HullFaces hull = hull_faces(chosen);
    if (hull.fault) return corners;  // so flat that its outermost corners are
    const auto planes = planes_of(hull);
    const auto [farthest, out] = farthest_of(corners, planes);
    if (out > 0.0 && chosen.size() < kMaxMeshCorners) {
      chosen.push_back(corners[farthest]);
      continue;
    }
    off = farthest_of(all, planes).second;
    return hull.corners;
  }
}

/// All that a file has, in its own frame.
struct Soup {
  std::vector<Eigen::Vector3d> points;
  std::vector<Face> faces;
};

/// `matrix` takes a point of the node to the file's frame; a tree no deeper than the file is long.
std::optional<std::string> gather(const aiScene& scene, Soup& soup) {
  struct Open {
    const aiNode* node;
    aiMatrix4x4 matrix;
  };
  std::vector<Open> open = {{scene.mRootNode, aiMatrix4x4()}};
  while (!open.empty()) {
    const Open at = open.back();
    open.pop_back();
    const aiMatrix4x4 matrix = at.matrix * at.node->mTransformation;
    for (unsigned i = 0; i < at.node->mNumMeshes; ++i) {
      const aiMesh& mesh = *scene.mMeshes[at.node->mMeshes[i]];
      const auto first = static_cast<std::uint32_t>(soup.points.size());
      if (soup.faces.size() + mesh.mNumFaces > kMaxMeshFaces ||
          soup.points.size() + mesh.mNumVertices > 3 * kMaxMeshFaces) {
        return fmt::format("has more than {} faces", kMaxMeshFaces);
      }
      for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
        const aiVector3D p = matrix * mesh.mVertices[k];
        soup.points.emplace_back(p.x, p.y, p.z);
      }
      for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
        const aiFace& face = mesh.mFaces[k];
        if (face.mNumIndices != 3) continue;  // points and lines, which are no surface
        soup.faces.push_back(
            {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
      }
    }
    for (unsigned i = 0; i < at.node->mNumChildren; ++i) {
      open.push_back({at.node->mChildren[i], matrix});
    }
  }
  return std::nullopt;
}

/// The corners of the faces that have an area: a vertex of lines and points alone is no surface.
std::vector<Eigen::Vector3d> surface_points(const Soup& soup) {
  std::vector<bool> used(soup.points.size(), false);
  for (const Face& face : soup.faces) {
    const Eigen::Vector3d a = soup.points[face[1]] - soup.points[face[0]],
                          b = soup.points[face[2]] - soup.points[face[0]];
    if (a.cross(b).norm() <= 1e-12 * std::max(a.squaredNorm(), b.squaredNorm())) continue;
    for (const auto corner : face) used[corner] = true;
  }
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) out.push_back(soup.points[i]);
  }
  return out;
}

/// How the faces meet. By places: files repeat their corners.
struct Closure {
  bool is_closed = true;    // each edge has an even number of faces
  bool is_oriented = true;  // as many of them go round it one way as the other
};
Closure closure_of(const Soup& soup) {
  std::map<std::array<double, 3>, std::uint32_t> number;
  std::vector<std::uint32_t> same;
  for (const auto& p : soup.points) {
    const auto next = static_cast<std::uint32_t>(number.size());
    same.push_back(number.emplace(std::array<double, 3>{p.x(), p.y(), p.z()}, next).first->second);
  }
  struct Edge {
    int faces = 0, turns = 0;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Edge> edges;
  for (const Face& face : soup.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto a = same[face[i]], b = same[face[(i + 1) % 3]];
      if (a == b) continue;
      Edge& edge = edges[std::minmax(a, b)];
      ++edge.faces;
      edge.turns += a < b ? 1 : -1;
    }
  }
  Closure out;
  for (const auto& [ends, edge] : edges) {
    out.is_closed = out.is_closed && edge.faces % 2 == 0;
    out.is_oriented = out.is_oriented && edge.turns == 0;
  }
  return out;
}

MeshCorners read_mesh(const std::string& text, const std::string& extension,
                      const Eigen::Vector3d& scale) {
  MeshCorners out;
  Assimp::Importer importer;
  // As the file has them: others would turn a file whose z is up.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFileFromMemory(text.data(), text.size(),
                                                     aiProcess_Triangulate, extension.c_str());
  if (scene == nullptr || scene->mRootNode == nullptr) {
    std::string why = importer.GetErrorString();
    std::replace(why.begin(), why.end(), '\n', ' ');
    const std::string_view own = " for $$$___magic___$$$";
    if (const auto at = why.find(own); at != why.npos) why.erase(at);
    out.fault = fmt::format("cannot be read: {}", why.substr(0, 200));
    return out;
  }
  Soup soup;
  out.fault = gather(*scene, soup);
  if (out.fault) return out;
  for (auto& p : soup.points) {
    p = p.cwiseProduct(scale);
    if (!p.allFinite()) {
      out.fault = "has a corner that is no number";
      return out;
    }
  }
  if (soup.faces.empty()) {
    out.fault = "has no faces";
    return out;
  }
  out.faces = soup.faces.size();
  const Closure closure = closure_of(soup);
  if (closure.is_oriented) out.volume = volume_of(soup.points, soup.faces);
  const HullFaces hull = hull_faces(surface_points(soup));
  out.fault = hull.fault;
  if (out.fault) return out;
  out.hull_corners = hull.corners.size();
  out.hull_volume = volume_of(hull.corners, hull.faces);
  // Faces of both sides of a sheet close nothing in, either.
  constexpr double kNoVolume = 1e-6;
  out.is_open =
      !closure.is_closed || (closure.is_oriented && out.volume < kNoVolume * out.hull_volume);
  if (out.is_open) out.volume = 0.0;
  out.corners = hull.corners;
  if (hull.corners.size() <= kMaxMeshCorners) return out;
  out.corners = chosen_corners(hull.corners, out.off);
  if (out.corners.size() > kMaxMeshCorners) out.fault = "is all but flat";
  return out;
}

constexpr MeshFunctions kFunctions = {&read_mesh, &hull_faces};

}  // namespace

extern "C" __attribute__((visibility("default"))) const MeshFunctions* parallax_mesh_functions(
    const char* version) {
  return std::string_view(version) == PARALLAX_IMPORT_VERSION ? &kFunctions : nullptr;
}

}  // namespace parallax::harness
