// Contacts of boxes and hulls held against FCL, another library's tests of overlap.

#include <doctest/doctest.h>

#if !__has_include(<fcl/narrowphase/collision.h>)

#include <cstdio>

TEST_CASE("held against FCL") { std::puts("SKIPPED: FCL is not here (libfcl-dev)"); }

#else
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/collision.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "harness/engine/box_contacts.h"
#include "harness/engine/hull_contacts.h"
#include "harness/world/convex_hull.h"

namespace parallax::harness {
namespace {

class FclChance {
 public:
  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  Eigen::Vector3d vector(double most) {
    const double x = within(-most, most), y = within(-most, most);
    return {x, y, within(-most, most)};
  }
  Eigen::Matrix3d turn() {
    return Eigen::AngleAxisd(within(-3.1, 3.1), vector(1.0).normalized()).toRotationMatrix();
  }

 private:
  std::mt19937 engine_{31};
};

constexpr double kShallow_m = 0.002;

struct Overlap {
  double depth_m = 0.0;
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();  // from the first to the second
};

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

struct PlacedGeometry {
  Geometry shape;
  Eigen::Vector3d p_W;
  Eigen::Matrix3d R_W;
};

/// The deepest contact that FCL knows, if they overlap.
std::optional<Overlap> fcl_overlap(const PlacedGeometry& first, const PlacedGeometry& second) {
  fcl::CollisionObjectd a(first.shape, first.R_W, first.p_W),
      b(second.shape, second.R_W, second.p_W);
  fcl::CollisionRequestd request(16, true);
  request.gjk_solver_type = fcl::GJKSolverType::GST_LIBCCD;
  fcl::CollisionResultd result;
  if (fcl::collide(&a, &b, request, result) == 0) return std::nullopt;
  Overlap out;
  for (std::size_t i = 0; i < result.numContacts(); ++i) {
    const auto& contact = result.getContact(i);
    if (contact.penetration_depth > out.depth_m) out = {contact.penetration_depth, contact.normal};
  }
  return out;
}

PlacedBox drawn_box(FclChance& chance) {
  return {chance.vector(0.35),
          {chance.within(0.05, 0.4), chance.within(0.05, 0.4), chance.within(0.05, 0.4)},
          chance.turn()};
}

PlacedGeometry placed(const PlacedBox& box) {
  return {std::make_shared<fcl::Boxd>(Eigen::Vector3d(2.0 * box.half_m)), box.p_W, box.R_WB};
}

TEST_CASE("boxes touch where FCL says so, as deep and along the same line") {
  FclChance chance;
  int touching = 0, apart = 0;
  for (int round = 0; round < 3000; ++round) {
    const PlacedBox first = drawn_box(chance), second = drawn_box(chance);
    const auto theirs = fcl_overlap(placed(first), placed(second));
    const BoxContacts ours = contacts_of(first, second);
    if (theirs && theirs->depth_m < 1e-6) continue;  // they only just touch
    CAPTURE(round);
    REQUIRE((ours.count > 0) == theirs.has_value());
    ++(theirs ? touching : apart);
    if (!theirs) continue;
    double deepest = 0.0;
    for (int i = 0; i < ours.count; ++i)
      deepest = std::max(deepest, ours.points[static_cast<std::size_t>(i)].depth_m);
    // Both take a face before edges that overlap a little less: FCL within a twentieth.
    CHECK(deepest > theirs->depth_m / 1.06 - 1e-9);
    CHECK(deepest < 1.06 * theirs->depth_m + 1e-9);
  }
  CHECK(touching > 500);
  CHECK(apart > 500);
}

/// A prism with three sides, cut askew.
ConvexHull drawn_prism(FclChance& chance) {
  std::vector<Eigen::Vector3d> corners;
  for (const double z : {-1.0, 1.0}) {
    for (int i = 0; i < 3; ++i) {
      const double angle = 2.0943951 * i, r = 0.25;
      corners.emplace_back(r * std::cos(angle), r * std::sin(angle), z * 0.1);
    }
  }
  const Eigen::Matrix3d stretch =
      Eigen::Vector3d(chance.within(0.5, 1.5), chance.within(0.5, 1.5), chance.within(0.5, 1.5))
          .asDiagonal();
  for (Eigen::Vector3d& corner : corners) corner = stretch * corner;
  const std::vector<std::array<std::uint32_t, 3> > faces = {
      {0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  Eigen::Vector3d middle;
  std::string why;
  auto hull = hull_with(corners, faces, middle, why);
  REQUIRE_MESSAGE(hull, why);
  return *std::move(hull);
}

PlacedGeometry placed(const ConvexHull& hull, const Eigen::Vector3d& p_W,
                      const Eigen::Matrix3d& R_W) {
  auto vertices = std::make_shared<std::vector<Eigen::Vector3d> >(hull.vertices);
  auto faces = std::make_shared<std::vector<int> >();
  for (const auto& face : hull.faces) {
    faces->push_back(3);
    for (const std::uint32_t corner : face) faces->push_back(static_cast<int>(corner));
  }
  return {
      std::make_shared<fcl::Convexd>(vertices, static_cast<int>(hull.faces.size()), faces, true),
      p_W, R_W};
}

TEST_CASE("contacts of hulls lie within both, and the deepest is as deep as FCL says") {
  FclChance chance;
  int with_faces = 0, overlapping = 0;
  for (int round = 0; round < 600; ++round) {
    const ConvexHull a = drawn_prism(chance), b = drawn_prism(chance);
    const Eigen::Vector3d p_A = chance.vector(0.1);
    Eigen::Vector3d p_B = chance.vector(0.2);
    const Eigen::Matrix3d R_A = chance.turn(), R_B = chance.turn();
    auto theirs = fcl_overlap(placed(a, p_A, R_A), placed(b, p_B, R_B));
    if (!theirs || theirs->depth_m < kShallow_m) continue;
    // Bodies that rest on one another overlap by little.
    p_B += (theirs->depth_m - kShallow_m) * theirs->normal_W;
    theirs = fcl_overlap(placed(a, p_A, R_A), placed(b, p_B, R_B));
    if (!theirs || theirs->depth_m < 0.5 * kShallow_m) continue;
    ++overlapping;
    const BoxContacts ours = hull_contacts(placed_hull(a, p_A, R_A), placed_hull(b, p_B, R_B),
                                           theirs->normal_W, theirs->depth_m);
    if (ours.count == 0) continue;  // they touch by edges
    ++with_faces;
    CAPTURE(round);
    double deepest = 0.0;
    for (int i = 0; i < ours.count; ++i) {
      const BoxContact& contact = ours.points[static_cast<std::size_t>(i)];
      deepest = std::max(deepest, contact.depth_m);
      CHECK(a.depth_of(R_A.transpose() * (contact.p_W - p_A)) > -kShallow_m);
      CHECK(b.depth_of(R_B.transpose() * (contact.p_W - p_B)) > -kShallow_m);
    }
    // The common part may be less deep than they are to be moved apart.
    CHECK(deepest > 0.5 * theirs->depth_m);
    CHECK(deepest < 1.1 * theirs->depth_m);
  }
  CHECK(overlapping > 200);
  CHECK(with_faces > 100);
}

}  // namespace
}  // namespace parallax::harness

#endif
