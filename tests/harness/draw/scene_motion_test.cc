#include <doctest/doctest.h>

#include <cmath>

#include "harness/draw/action_recorder.h"

namespace parallax::harness {
namespace {

using Points = std::vector<Eigen::Vector3d>;

TEST_CASE("a simplified way keeps its ends, its corners and the distance to what it leaves out") {
  Points points;
  for (int i = 0; i <= 100; ++i) points.emplace_back(0.01 * i, std::sin(0.1 * i), 0.0);
  CHECK(simplified(points, 0.0).size() == points.size());
  for (const double tolerance_m : {0.01, 0.1, 0.5}) {
    CAPTURE(tolerance_m);
    const Points kept = simplified(points, tolerance_m);
    CHECK(kept.size() < points.size());
    CHECK(kept.front() == points.front());
    CHECK(kept.back() == points.back());
    for (const auto& p : points) {
      double nearest_m = 1e9;
      for (std::size_t i = 1; i < kept.size(); ++i) {
        const Eigen::Vector3d way = kept[i] - kept[i - 1];
        for (int part = 0; part <= 200; ++part) {
          nearest_m = std::min(nearest_m, (p - kept[i - 1] - 0.005 * part * way).norm());
        }
      }
      CHECK(nearest_m < tolerance_m + 0.02);
    }
  }
  CHECK(simplified({}, 0.1).empty());
  CHECK(simplified(Points(5, Eigen::Vector3d::Ones()), 0.1).size() == 2);
}

TEST_CASE("half way is that of the drawer or item that moved most, else of the busiest hand") {
  const auto along_x = [](const std::vector<double>& all_m) {
    Points points;
    for (const double x : all_m) points.emplace_back(x, 0.0, 0.0);
    return points;
  };
  const SceneTrack hand{"left", SceneKind::kGripper, along_x({0.0, 0.9, 1.0, 1.0, 1.0})};
  const SceneTrack item{"milk", SceneKind::kItem, along_x({0.0, 0.0, 0.0, 0.2, 0.3})};
  const SceneTrack still{"bowl", SceneKind::kItem, along_x({0.0, 0.0, 0.0, 0.0, 0.001})};
  const SceneTrack base{"base", SceneKind::kRobot, along_x({0.0, 1.0, 2.0, 3.0, 4.0})};
  CHECK(half_way({hand, item, still, base}, 0.02) == 3);
  CHECK(half_way({hand, still, base}, 0.02) == 1);
  CHECK_FALSE(half_way({still, base}, 0.02).has_value());
  CHECK_FALSE(half_way({}, 0.02).has_value());
}

}  // namespace
}  // namespace parallax::harness
