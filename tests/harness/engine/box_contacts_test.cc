// Contact points of boxes, compared with geometry that knows nothing of faces, edges and clipping.

#include "harness/engine/box_contacts.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace parallax::harness {
namespace {

class BoxChance {
 public:
  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  Eigen::Vector3d direction() {
    for (;;) {
      const Eigen::Vector3d v(within(-1.0, 1.0), within(-1.0, 1.0), within(-1.0, 1.0));
      if (v.norm() > 0.1 && v.norm() < 1.0) return v.normalized();
    }
  }
  Eigen::Matrix3d turn(double most_rad) {
    return Eigen::AngleAxisd(within(-most_rad, most_rad), direction()).toRotationMatrix();
  }

 private:
  std::mt19937 engine_{11};
};

/// Along a direction from the first box to the second: how far they would have to be shifted.
double overlap_m(const PlacedBox& a, const PlacedBox& b, const Eigen::Vector3d& n) {
  return (a.R_WB.transpose() * n).cwiseAbs().dot(a.half_m) +
         (b.R_WB.transpose() * n).cwiseAbs().dot(b.half_m) - n.dot(b.p_W - a.p_W);
}

/// The least overlap over all directions, by trying many and then ever nearer ones.
double least_overlap_m(const PlacedBox& a, const PlacedBox& b, BoxChance& chance) {
  std::vector<std::pair<double, Eigen::Vector3d>> best;
  for (int i = 0; i < 1500; ++i) {
    const Eigen::Vector3d n = chance.direction();
    best.emplace_back(overlap_m(a, b, n), n);
  }
  std::partial_sort(best.begin(), best.begin() + 24, best.end(),
                    [](const auto& x, const auto& y) { return x.first < y.first; });
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 24; ++k) {
    auto [depth, n] = best[k];
    double reach = 0.05;
    for (int i = 0; i < 1500; ++i) {
      const Eigen::Vector3d other = (n + reach * chance.direction()).normalized();
      const double overlap = overlap_m(a, b, other);
      if (overlap < depth) {
        depth = overlap;
        n = other;
      } else {
        reach = std::max(0.99 * reach, 1e-9);
      }
    }
    least = std::min(least, depth);
  }
  return least;
}

bool is_in(const PlacedBox& box, const Eigen::Vector3d& p_W, double room_m) {
  const Eigen::Vector3d p = box.R_WB.transpose() * (p_W - box.p_W);
  return ((p.cwiseAbs() - box.half_m).array() <= room_m).all();
}

double deepest_of(const BoxContacts& contacts) {
  double deepest = 0.0;
  for (int i = 0; i < contacts.count; ++i) {
    deepest = std::max(deepest, contacts.points[static_cast<std::size_t>(i)].depth_m);
  }
  return deepest;
}

TEST_CASE("boxes that overlap touch as deep as the least shift that parts them, others do not") {
  BoxChance chance;
  int apart = 0, touching = 0, by_edges = 0;
  for (int i = 0; i < 150; ++i) {
    CAPTURE(i);
    PlacedBox a{Eigen::Vector3d::Zero(), {0.1, 0.15, 0.2}, chance.turn(3.0)};
    PlacedBox b{Eigen::Vector3d::Zero(), {0.12, 0.05, 0.3}, chance.turn(3.0)};
    // Put so that they overlap a little, seen along some direction.
    const Eigen::Vector3d way = chance.direction();
    double far = 1.0, near = 0.0;
    while (far - near > 1e-9) {
      const double middle = 0.5 * (far + near);
      b.p_W = middle * way;
      (contacts_of(a, b).count > 0 ? near : far) = middle;
    }
    b.p_W = (near + chance.within(-0.01, 0.002)) * way;
    const double least_m = least_overlap_m(a, b, chance);
    const BoxContacts found = contacts_of(a, b);
    if (least_m < 0.0) {
      CHECK(found.count == 0);
      ++apart;
      continue;
    }
    if (least_m < 1e-5) continue;  // the search above is not that close
    ++touching;
    REQUIRE(found.count > 0);
    CHECK(found.normal_W.norm() == doctest::Approx(1.0));
    // Within a tenth; the search finds a little more than the least depth.
    CHECK(deepest_of(found) > 0.88 * least_m);
    // A face may be taken that is off by a fiftieth.
    CHECK(overlap_m(a, b, found.normal_W) < 1.11 * least_m + 0.02 * (a.half_m + b.half_m).norm());
    CHECK(deepest_of(found) < 1.11 * least_m);
    if (found.count == 1) ++by_edges;
    for (int k = 0; k < found.count; ++k) {
      const BoxContact& point = found.points[static_cast<std::size_t>(k)];
      CHECK(is_in(a, point.p_W, 0.5 * point.depth_m));
      CHECK(is_in(b, point.p_W, 0.5 * point.depth_m));
    }
  }
  CHECK(apart > 10);
  CHECK(touching > 80);
  CHECK(by_edges > 20);
}

TEST_CASE("the same two boxes touch alike in whatever order they are asked about") {
  BoxChance chance;
  for (int i = 0; i < 200; ++i) {
    CAPTURE(i);
    const PlacedBox a{Eigen::Vector3d::Zero(), {0.1, 0.15, 0.2}, chance.turn(3.0)};
    const PlacedBox b{0.2 * chance.direction(), {0.12, 0.05, 0.3}, chance.turn(3.0)};
    const BoxContacts one = contacts_of(a, b), other = contacts_of(b, a);
    REQUIRE(one.count == other.count);
    if (one.count == 0) continue;
    CHECK((one.normal_W + other.normal_W).norm() < 1e-9);
    CHECK(deepest_of(one) == doctest::Approx(deepest_of(other)));
  }
}

TEST_CASE(
    "a face laid on a face, off by a hair in any way, touches at the corners of what they share") {
  BoxChance chance;
  const double depth_m = 0.0005;
  for (const double tilt_rad : {0.0, 1e-16, 1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
    CAPTURE(tilt_rad);
    for (int i = 0; i < 300; ++i) {
      CAPTURE(i);
      // Pad and spoon handle, crosswise: they share 20 by 19 mm; somewhere, turned anyhow.
      const Eigen::Matrix3d R = chance.turn(3.0);
      const PlacedBox pad{Eigen::Vector3d(0.3, -0.2, 0.7), {0.010, 0.005, 0.013}, R};
      PlacedBox handle{Eigen::Vector3d::Zero(), {0.075, 0.005, 0.0095}, R * chance.turn(tilt_rad)};
      handle.p_W = pad.p_W + R * Eigen::Vector3d(0.01, 0.010 - depth_m, 0.002);
      const BoxContacts found = contacts_of(pad, handle);
      REQUIRE(found.count >= 4);
      CHECK(found.normal_W.dot(R.col(1)) > 1.0 - 1e-5);
      std::vector<Eigen::Vector3d> corners;
      for (const double x : {-0.010, 0.010}) {
        for (const double z : {-0.0075, 0.0115}) corners.emplace_back(x, 0.005, z);
      }
      for (const Eigen::Vector3d& corner : corners) {
        double nearest_m = 1.0;
        for (int k = 0; k < found.count; ++k) {
          const BoxContact& point = found.points[static_cast<std::size_t>(k)];
          nearest_m = std::min(nearest_m, (pad.p_W + R * corner - point.p_W).norm());
          CHECK(std::abs(point.depth_m - depth_m) < 0.1 * tilt_rad + 1e-9);
        }
        CHECK(nearest_m < depth_m + 0.1 * tilt_rad);
      }
    }
  }
}

TEST_CASE("a box in another one is as deep in it as the nearest face is away") {
  const PlacedBox outer{Eigen::Vector3d::Zero(), {1.0, 2.0, 3.0}, Eigen::Matrix3d::Identity()};
  const PlacedBox inner{{0.7, 0.1, 0.2}, {0.1, 0.1, 0.1}, Eigen::Matrix3d::Identity()};
  const BoxContacts found = contacts_of(outer, inner);
  REQUIRE(found.count == 4);
  CHECK((found.normal_W - Eigen::Vector3d::UnitX()).norm() < 1e-12);
  CHECK(deepest_of(found) == doctest::Approx(0.4));
}

}  // namespace
}  // namespace parallax::harness
