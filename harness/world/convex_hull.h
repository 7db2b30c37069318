#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace parallax::harness {

inline constexpr std::size_t kMaxHullVertices = 256, kMaxHullFaces = 2 * kMaxHullVertices;

/// A convex body with flat faces. Places in a frame whose origin is the middle of the box round it.
struct ConvexHull {
  std::vector<Eigen::Vector3d> vertices;               // [m]
  std::vector<std::array<std::uint32_t, 3>> faces;     // counter-clockwise from outside
  std::vector<Eigen::Vector3d> normals;                // of the faces that are no slivers, outwards
  std::vector<double> offsets;                         // inside: normal * p <= offset [m]
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();    // of the box round it
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // [m]
  double volume_m3 = 0.0;
  Eigen::Matrix3d moments_m2 = Eigen::Matrix3d::Zero();  // of inertia about the centroid, per kg

  /// The depth of the point inside the hull. Below 0: it is outside, at least so far from one face.
  double depth_of(const Eigen::Vector3d& p) const;
  /// Lowest and highest coordinates when R turns it.
  std::pair<Eigen::Vector3d, Eigen::Vector3d> span(const Eigen::Matrix3d& R) const;
};

/// Faces of nothing but corners, in any order; they enclose something convex, else a message. Where
/// the middle of the box round the corners was is told in `middle`.
std::optional<ConvexHull> hull_with(std::vector<Eigen::Vector3d> corners,
                                    const std::vector<std::array<std::uint32_t, 3>>& faces,
                                    Eigen::Vector3d& middle, std::string& why);

}  // namespace parallax::harness
