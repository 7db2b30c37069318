// A convex polyhedron from its corners and triangles.
//
// Planes are turned outwards from the mean of the corners; triangles too thin to have a
// direction give none. Volume, centroid and moments are sums over the tetrahedra from the origin
// to each triangle, which is exact for any closed surface. The surface is accepted if each
// directed edge occurs once and so does its opposite, and if no corner lies outside of a plane
// by more than rounding. The depth of a point is its least distance below the planes. Cost:
// linear in the faces, planes times corners for the check.

#include "harness/world/convex_hull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace parallax::harness {
namespace {

constexpr double kRounding = 1e-6;  // of the hull's size
constexpr double kSliver = 1e-9;    // of its square: a face that has no direction

struct Corners {
  const Eigen::Vector3d &a, &b, &c;
};

Corners corners_of(const ConvexHull& hull, const std::array<std::uint32_t, 3>& face) {
  return {hull.vertices[face[0]], hull.vertices[face[1]], hull.vertices[face[2]]};
}

/// Planes of the faces, each turned outwards. Those of slivers follow from their neighbours.
void add_planes(ConvexHull& hull) {
  Eigen::Vector3d inside = Eigen::Vector3d::Zero();
  for (const auto& vertex : hull.vertices) inside += vertex;
  inside /= static_cast<double>(hull.vertices.size());
  for (auto& face : hull.faces) {
    const auto [a, b, c] = corners_of(hull, face);
    Eigen::Vector3d normal = (b - a).cross(c - a);
    const double length = normal.norm(), size_m = hull.size_m.maxCoeff();
    if (!(length > kSliver * size_m * size_m)) continue;
    normal /= length;
    if (normal.dot(inside - a) > 0.0) {
      normal = -normal;
      std::swap(face[1], face[2]);
    }
    hull.offsets.push_back(normal.dot(hull.vertices[face[0]]));
    hull.normals.push_back(normal);
  }
}

/// Volume, centroid and moments as sums over tetrahedra from the origin.
void add_mass(ConvexHull& hull) {
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // of p p^T over the volume
  for (const auto& face : hull.faces) {
    const auto [a, b, c] = corners_of(hull, face);
    const double volume = a.dot(b.cross(c)) / 6.0;
    const Eigen::Vector3d sum = a + b + c;
    hull.volume_m3 += volume;
    first += volume * sum / 4.0;
    second += volume / 20.0 *
              (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  if (!(hull.volume_m3 > 0.0)) return;
  hull.centroid = first / hull.volume_m3;
  const Eigen::Matrix3d about = second / hull.volume_m3 - hull.centroid * hull.centroid.transpose();
  hull.moments_m2 = about.trace() * Eigen::Matrix3d::Identity() - about;
}

/// Each edge has two faces, and no corner lies outside of a face.
bool is_convex(const ConvexHull& hull) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges, back;
  for (const auto& face : hull.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      edges.emplace_back(face[i], face[(i + 1) % 3]);
      back.emplace_back(face[(i + 1) % 3], face[i]);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(back.begin(), back.end());
  if (edges != back || std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  const double play = kRounding * hull.size_m.maxCoeff();
  return std::all_of(hull.vertices.begin(), hull.vertices.end(),
                     [&](const Eigen::Vector3d& p) { return hull.depth_of(p) >= -play; });
}

}  // namespace

double ConvexHull::depth_of(const Eigen::Vector3d& p) const {
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < normals.size(); ++i) {
    depth = std::min(depth, offsets[i] - normals[i].dot(p));
  }
  return depth;
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> ConvexHull::span(const Eigen::Matrix3d& R) const {
  Eigen::Vector3d low = R * vertices.front(), high = low;
  for (const auto& vertex : vertices) {
    const Eigen::Vector3d p = R * vertex;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {low, high};
}

std::optional<ConvexHull> hull_with(std::vector<Eigen::Vector3d> corners,
                                    const std::vector<std::array<std::uint32_t, 3>>& faces,
                                    Eigen::Vector3d& middle, std::string& why) {
  if (corners.size() < 4 || faces.size() < 4) why = "has fewer than four corners or faces";
  if (corners.size() > kMaxHullVertices || faces.size() > kMaxHullFaces) {
    why = "has more than 256 corners or 512 faces";
  }
  for (const auto& face : faces) {
    for (const auto corner : face) {
      if (corner >= corners.size()) why = "has a face of a corner that there is not";
    }
  }
  for (const auto& corner : corners) {
    if (!corner.allFinite()) why = "has a corner that is no number";
  }
  if (!why.empty()) return std::nullopt;
  ConvexHull hull;
  hull.vertices = std::move(corners);
  hull.faces = faces;
  const auto [low, high] = hull.span(Eigen::Matrix3d::Identity());
  middle = 0.5 * (low + high);
  hull.size_m = high - low;
  for (auto& vertex : hull.vertices) vertex -= middle;
  add_planes(hull);
  add_mass(hull);
  if (!is_convex(hull) || !(hull.volume_m3 > 0.0)) {
    why = "is not closed and convex, or has no volume";
    return std::nullopt;
  }
  return hull;
}

}  // namespace parallax::harness
