// Contacts of two boxes by separating axes (Gottschalk, Lin and Manocha 1996) and clipping.
//
// The 15 candidate axes are the normals of both boxes' faces and the cross products of their
// edges; if the boxes are apart along any of them there is no contact. Else the axis of the
// least overlap is the normal. For a face, the other box's face that looks most against it is
// clipped at its four sides (Sutherland and Hodgman 1974), and the corners below its plane are
// the contacts, eight at most. For two edges it is the point midway between their nearest
// points. Where edges overlap a little less than a face that is about as deep and has the same
// normal, the face is taken, so that a box laid flat stands on its corners.
//
// Cost: constant.

#include "harness/engine/box_contacts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace parallax::harness {
namespace {

constexpr double kParallel = 1e-6;     // sine of the angle below which edges have no common normal
constexpr double kSameFace_m = 1e-9;   // by which a later face has to overlap less
constexpr double kAsDeep = 0.1;        // share by which a face's points may differ from the edges
constexpr double kSameWay = 0.9998;    // cosine between a face's normal and that of the edges
constexpr double kSamePoint_m = 1e-7;  // of corners that clipping made twice

struct AxisOverlap {
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  // from the first box to the second
  double depth_m = std::numeric_limits<double>::infinity();
  Eigen::Index first = 0, second = 0;  // of faces: 0 or 1, and its axis; of edges: their axes
};

double reach_m(const PlacedBox& box, const Eigen::Vector3d& direction) {
  return (box.R_WB.transpose() * direction).cwiseAbs().dot(box.half_m);
}

AxisOverlap overlap_along(const PlacedBox& a, const PlacedBox& b, const Eigen::Vector3d& axis) {
  const double apart_m = axis.dot(b.p_W - a.p_W);
  return {apart_m < 0.0 ? Eigen::Vector3d(-axis) : axis,
          reach_m(a, axis) + reach_m(b, axis) - std::abs(apart_m)};
}

/// The least overlap of the faces and that of the edges, which is infinite where all are parallel.
struct LeastOverlaps {
  AxisOverlap face, edges;
};

/// None where an axis parts the boxes.
std::optional<LeastOverlaps> least_overlaps(const PlacedBox& a, const PlacedBox& b) {
  LeastOverlaps least;
  for (Eigen::Index i = 0; i < 6; ++i) {
    AxisOverlap found = overlap_along(a, b, (i < 3 ? a : b).R_WB.col(i % 3));
    if (found.depth_m < 0.0) return std::nullopt;
    found.first = i / 3;
    found.second = i % 3;
    if (found.depth_m < least.face.depth_m - kSameFace_m) least.face = found;
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      const Eigen::Vector3d across = a.R_WB.col(i).cross(b.R_WB.col(j));
      const double sine = across.norm();
      if (sine < kParallel) continue;
      AxisOverlap found = overlap_along(a, b, across / sine);
      if (found.depth_m < 0.0) return std::nullopt;
      found.first = i;
      found.second = j;
      if (found.depth_m < least.edges.depth_m) least.edges = found;
    }
  }
  return least;
}

/// Corners of a face, seen from another face: x and y in its plane, z above it.
struct Polygon {
  std::array<Eigen::Vector3d, 8> corners;
  std::size_t count = 0;
  void add(const Eigen::Vector3d& corner) {
    if (count < corners.size()) corners[count++] = corner;
  }
};

/// The part of the polygon at `sign * coordinate <= limit`.
Polygon clipped(const Polygon& polygon, Eigen::Index coordinate, double sign, double limit) {
  Polygon inside;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Eigen::Vector3d& from = polygon.corners[i];
    const Eigen::Vector3d& to = polygon.corners[(i + 1) % polygon.count];
    const double before = sign * from[coordinate] - limit, after = sign * to[coordinate] - limit;
    if (before <= 0.0) inside.add(from);
    if ((before < 0.0 && after > 0.0) || (before > 0.0 && after < 0.0)) {
      inside.add(from + before / (before - after) * (to - from));
    }
  }
  return inside;
}

/// A face of one box as the plane that the other one dips into.
struct FaceFrame {
  Eigen::Vector3d p_W;   // its middle
  Eigen::Matrix3d R_WF;  // z: out of the box
  double half_x_m = 0.0, half_y_m = 0.0;
};

FaceFrame frame_of(const PlacedBox& box, Eigen::Index axis, const Eigen::Vector3d& outwards_W) {
  const Eigen::Index x = (axis + 1) % 3, y = (axis + 2) % 3;
  FaceFrame frame;
  frame.p_W = box.p_W + box.half_m[axis] * outwards_W;
  frame.R_WF.col(0) = box.R_WB.col(x);
  frame.R_WF.col(1) = box.R_WB.col(y);
  frame.R_WF.col(2) = outwards_W;
  frame.half_x_m = box.half_m[x];
  frame.half_y_m = box.half_m[y];
  return frame;
}

/// The face of a box that looks most against the frame's plane, in the frame.
Polygon facing(const PlacedBox& box, const FaceFrame& frame) {
  const Eigen::Matrix3d R_FB = frame.R_WF.transpose() * box.R_WB;
  Eigen::Index axis = 0;
  R_FB.row(2).cwiseAbs().maxCoeff(&axis);
  const double side = R_FB(2, axis) > 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d middle =
      frame.R_WF.transpose() * (box.p_W - frame.p_W) + side * box.half_m[axis] * R_FB.col(axis);
  const Eigen::Index x = (axis + 1) % 3, y = (axis + 2) % 3;
  const Eigen::Vector3d dx = box.half_m[x] * R_FB.col(x), dy = box.half_m[y] * R_FB.col(y);
  Polygon face;
  for (const auto& [sx, sy] : {std::pair{1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}}) {
    face.add(middle + sx * dx + sy * dy);
  }
  return face;
}

void add_point(BoxContacts& contacts, const Eigen::Vector3d& p_W, double depth_m) {
  for (int i = 0; i < contacts.count; ++i) {
    const BoxContact& known = contacts.points[static_cast<std::size_t>(i)];
    if ((known.p_W - p_W).squaredNorm() < kSamePoint_m * kSamePoint_m) return;
  }
  contacts.points[static_cast<std::size_t>(contacts.count++)] = {p_W, depth_m};
}

double deepest_m(const BoxContacts& contacts) {
  double deepest = 0.0;
  for (int i = 0; i < contacts.count; ++i) {
    deepest = std::max(deepest, contacts.points[static_cast<std::size_t>(i)].depth_m);
  }
  return deepest;
}

/// Clips the incident face against the reference face and returns the corners below the reference
/// plane.
BoxContacts face_contacts(const PlacedBox& a, const PlacedBox& b, const AxisOverlap& face) {
  const bool of_first = face.first == 0;
  const FaceFrame frame = frame_of(of_first ? a : b, face.second,
                                   of_first ? face.normal_W : Eigen::Vector3d(-face.normal_W));
  Polygon shared = facing(of_first ? b : a, frame);
  for (const double sign : {1.0, -1.0}) {
    shared = clipped(shared, 0, sign, frame.half_x_m);
    shared = clipped(shared, 1, sign, frame.half_y_m);
  }
  BoxContacts contacts;
  contacts.normal_W = face.normal_W;
  for (std::size_t i = 0; i < shared.count; ++i) {
    Eigen::Vector3d corner = shared.corners[i];
    const double depth_m = -corner.z();
    if (depth_m < 0.0) continue;
    corner.z() *= 0.5;
    add_point(contacts, frame.p_W + frame.R_WF * corner, depth_m);
  }
  return contacts;
}

/// The middle of the box's edge along `axis` that lies farthest in a direction.
Eigen::Vector3d edge_middle(const PlacedBox& box, Eigen::Index axis,
                            const Eigen::Vector3d& direction_W) {
  Eigen::Vector3d p_W = box.p_W;
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (i == axis) continue;
    const double side = box.R_WB.col(i).dot(direction_W) < 0.0 ? -1.0 : 1.0;
    p_W += side * box.half_m[i] * box.R_WB.col(i);
  }
  return p_W;
}

/// Where two edges are nearest to each other.
BoxContacts edge_contact(const PlacedBox& a, const PlacedBox& b, const AxisOverlap& edges) {
  const Eigen::Vector3d u = a.R_WB.col(edges.first), v = b.R_WB.col(edges.second);
  const Eigen::Vector3d p = edge_middle(a, edges.first, edges.normal_W);
  const Eigen::Vector3d q = edge_middle(b, edges.second, -edges.normal_W);
  const double cosine = u.dot(v), square = 1.0 - cosine * cosine;
  const Eigen::Vector3d way = q - p;
  const double half_a = a.half_m[edges.first], half_b = b.half_m[edges.second];
  const double s = std::clamp((way.dot(u) - cosine * way.dot(v)) / square, -half_a, half_a);
  const double t = std::clamp((cosine * way.dot(u) - way.dot(v)) / square, -half_b, half_b);
  BoxContacts contacts;
  contacts.normal_W = edges.normal_W;
  add_point(contacts, 0.5 * (p + s * u + q + t * v), edges.depth_m);
  return contacts;
}

}  // namespace

BoxContacts contacts_of(const PlacedBox& first, const PlacedBox& second) {
  const auto least = least_overlaps(first, second);
  if (!least) return {};
  BoxContacts contacts = face_contacts(first, second, least->face);
  const AxisOverlap &face = least->face, &edges = least->edges;
  if (std::isinf(edges.depth_m)) return contacts;
  if (contacts.count == 0) return edge_contact(first, second, edges);
  if (face.depth_m <= edges.depth_m) return contacts;
  const double differ_m = std::abs(deepest_m(contacts) - edges.depth_m);
  const bool alike = face.normal_W.dot(edges.normal_W) >= kSameWay;
  if (alike && differ_m <= kAsDeep * edges.depth_m) return contacts;
  return edge_contact(first, second, edges);
}

}  // namespace parallax::harness
