// Contacts of a face of a convex polyhedron with another one, as with boxes (box_contacts.cc).
//
// For each face of both, the overlap is how far the other polyhedron's lowest corner lies below
// its plane; the face of the least overlap is the reference. The other's face that looks most
// against it is clipped at the reference's edges, and the corners below its plane are contacts.
// Of many, the deepest is taken and then again and again the one farthest from those taken, up
// to eight, so that a body stands on all sides of its face. If the engine found a clearly lesser
// overlap along another normal, two edges touch, and there are none.
//
// Cost: faces times corners of the pair.

#include "harness/engine/hull_contacts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace parallax::harness {
namespace {

constexpr double kAsLittle = 0.1;      // share by which a face may overlap more than what was found
constexpr double kAlike = 0.9998;      // cosine between its normal and the one that was found
constexpr double kSamePlane_m = 1e-6;  // of corners of a face
constexpr double kSamePlace_m = 1e-7;  // of contacts

using Ring = std::vector<Eigen::Vector3d>;

struct LeastFace {
  bool of_first = true;
  std::size_t face = 0;
  double depth_m = std::numeric_limits<double>::infinity();
};

double overlap_below(const Eigen::Vector3d& normal, double offset, const Polyhedron& other) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& corner : other.corners_W) {
    lowest = std::min(lowest, normal.dot(corner));
  }
  return offset - lowest;
}

LeastFace least_face(const Polyhedron& a, const Polyhedron& b) {
  LeastFace least;
  for (const bool of_first : {true, false}) {
    const Polyhedron &own = of_first ? a : b, &other = of_first ? b : a;
    for (std::size_t i = 0; i < own.normals_W.size(); ++i) {
      const double depth_m = overlap_below(own.normals_W[i], own.offsets[i], other);
      // A later one has to overlap less by more than a rounding.
      if (depth_m < least.depth_m - kSamePlace_m) least = {of_first, i, depth_m};
    }
  }
  return least;
}

/// The corners of a face, counter-clockwise from outside.
Ring ring_of(const Polyhedron& body, std::size_t face) {
  const Eigen::Vector3d& normal = body.normals_W[face];
  Ring ring;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : body.corners_W) {
    if (std::abs(normal.dot(corner) - body.offsets[face]) > kSamePlane_m) continue;
    ring.push_back(corner);
    middle += corner;
  }
  if (ring.size() < 3) return {};
  middle /= static_cast<double>(ring.size());
  const Eigen::Vector3d x = (ring.front() - middle).normalized(), y = normal.cross(x);
  const auto angle = [&](const Eigen::Vector3d& p) {
    return std::atan2((p - middle).dot(y), (p - middle).dot(x));
  };
  std::sort(ring.begin(), ring.end(), [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    return angle(p) < angle(q);
  });
  return ring;
}

/// The part of a ring that is not beyond a plane.
Ring cut(const Ring& ring, const Eigen::Vector3d& outwards, const Eigen::Vector3d& on_plane) {
  Ring inside;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector3d &from = ring[i], &to = ring[(i + 1) % ring.size()];
    const double before = outwards.dot(from - on_plane), after = outwards.dot(to - on_plane);
    if (before <= 0.0) inside.push_back(from);
    if ((before < 0.0 && after > 0.0) || (before > 0.0 && after < 0.0)) {
      inside.push_back(from + before / (before - after) * (to - from));
    }
  }
  return inside;
}

/// The face that looks most against a direction.
std::size_t face_against(const Polyhedron& body, const Eigen::Vector3d& direction) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < body.normals_W.size(); ++i) {
    if (body.normals_W[i].dot(direction) < body.normals_W[best].dot(direction)) best = i;
  }
  return best;
}

/// The deepest, then again and again the one farthest from those taken.
void take_spread(std::vector<BoxContact>& found, BoxContacts& contacts) {
  while (!found.empty() && contacts.count < static_cast<int>(contacts.points.size())) {
    const auto worth = [&](const BoxContact& point) {
      if (contacts.count == 0) return point.depth_m;
      double nearest = std::numeric_limits<double>::infinity();
      for (int i = 0; i < contacts.count; ++i) {
        const BoxContact& taken = contacts.points[static_cast<std::size_t>(i)];
        nearest = std::min(nearest, (taken.p_W - point.p_W).squaredNorm());
      }
      return nearest;
    };
    const auto best = std::max_element(
        found.begin(), found.end(),
        [&](const BoxContact& p, const BoxContact& q) { return worth(p) < worth(q); });
    if (contacts.count > 0 && worth(*best) < kSamePlace_m * kSamePlace_m) return;
    contacts.points[static_cast<std::size_t>(contacts.count++)] = *best;
    found.erase(best);
  }
}

}  // namespace

Polyhedron placed_hull(const ConvexHull& hull, const Eigen::Vector3d& p_W,
                       const Eigen::Matrix3d& R_W) {
  Polyhedron placed;
  for (const auto& corner : hull.vertices) placed.corners_W.push_back(p_W + R_W * corner);
  for (std::size_t i = 0; i < hull.normals.size(); ++i) {
    placed.normals_W.push_back(R_W * hull.normals[i]);
    placed.offsets.push_back(hull.offsets[i] + placed.normals_W.back().dot(p_W));
  }
  return placed;
}

Polyhedron placed_box(const PlacedBox& box) {
  Polyhedron placed;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d side((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0,
                               (i & 4) != 0 ? 1.0 : -1.0);
    placed.corners_W.push_back(box.p_W + box.R_WB * side.cwiseProduct(box.half_m));
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      placed.normals_W.push_back(side * box.R_WB.col(axis));
      placed.offsets.push_back(box.half_m[axis] + placed.normals_W.back().dot(box.p_W));
    }
  }
  return placed;
}

BoxContacts hull_contacts(const Polyhedron& first, const Polyhedron& second,
                          const Eigen::Vector3d& normal_W, double depth_m) {
  const LeastFace least = least_face(first, second);
  BoxContacts contacts;
  if (!(least.depth_m >= 0.0) || std::isinf(least.depth_m)) return contacts;
  const Polyhedron &own = least.of_first ? first : second, &other = least.of_first ? second : first;
  const Eigen::Vector3d& outwards = own.normals_W[least.face];
  contacts.normal_W = least.of_first ? outwards : Eigen::Vector3d(-outwards);
  Ring shared = ring_of(other, face_against(other, outwards));
  const Ring border = ring_of(own, least.face);
  if (border.empty()) return contacts;
  for (std::size_t i = 0; i < border.size(); ++i) {
    const Eigen::Vector3d side = border[(i + 1) % border.size()] - border[i];
    shared = cut(shared, side.cross(outwards).normalized(), border[i]);
  }
  std::vector<BoxContact> found;
  double deepest_m = 0.0;
  for (const Eigen::Vector3d& corner : shared) {
    const double below_m = own.offsets[least.face] - outwards.dot(corner);
    if (below_m < 0.0) continue;
    found.push_back({corner + 0.5 * below_m * outwards, below_m});
    deepest_m = std::max(deepest_m, below_m);
  }
  const bool alike = contacts.normal_W.dot(normal_W) >= kAlike;
  const double most_m = (1.0 + kAsLittle) * depth_m, least_m = (1.0 - kAsLittle) * depth_m;
  if (least.depth_m <= most_m || (alike && deepest_m <= most_m && deepest_m >= least_m)) {
    take_spread(found, contacts);
  }
  return contacts;
}

}  // namespace parallax::harness
