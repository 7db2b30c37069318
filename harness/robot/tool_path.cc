#include "harness/robot/tool_path.h"

#include <algorithm>

namespace parallax::harness {
namespace {

constexpr double kStep_m = 0.010;    // of the sweeps
constexpr double kRetreat_m = 0.05;  // between the retreats that are tried
constexpr int kRetreats = 11;        // up to 0.5 m
constexpr double kHeight_m = 0.10;   // between the heights
constexpr double kSame_m = 1e-6;

/// Straight ways from a fixed start, in coordinates of the world.
class Ways {
 public:
  Ways(const Sweep& sweep, const Eigen::Vector3d& from) : sweep_(sweep), from_(from) {}

  bool free(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const auto hit = sweep_.along(a - from_, b - a, kStep_m);
    if (hit) blocked_ = hit;
    return !hit;
  }
  const std::optional<Obstacle>& blocked() const { return blocked_; }

 private:
  const Sweep& sweep_;
  Eigen::Vector3d from_;
  std::optional<Obstacle> blocked_;
};

/// The retreats from `point` from which the way up to `height_m` is free, nearest first.
std::vector<Eigen::Vector3d> shafts(Ways& ways, const Eigen::Vector3d& point,
                                    const Eigen::Vector3d& back, double height_m) {
  std::vector<Eigen::Vector3d> found;
  Eigen::Vector3d last = point;
  for (int i = 0; i < kRetreats && found.size() < 3; ++i) {
    const Eigen::Vector3d foot = point + i * kRetreat_m * back;
    if (!ways.free(last, foot)) break;
    last = foot;
    if (ways.free(foot, {foot.x(), foot.y(), height_m})) found.push_back(foot);
  }
  return found;
}

Eigen::Vector3d raised(const Eigen::Vector3d& p, double height_m) {
  return {p.x(), p.y(), height_m};
}

}  // namespace

ToolPath find_tool_path(const Sweep& sweep, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        const Eigen::Vector3d& back, double ceiling_m) {
  Ways ways(sweep, from);
  if (ways.free(from, to)) return {{to}, std::nullopt};
  const double lowest_m = std::max(from.z(), to.z());
  for (double height_m = lowest_m; height_m <= std::max(ceiling_m, lowest_m) + kSame_m;
       height_m += kHeight_m) {
    const auto starts = shafts(ways, from, back, height_m);
    const auto ends = starts.empty() ? starts : shafts(ways, to, back, height_m);
    for (const Eigen::Vector3d& start : starts) {
      for (const Eigen::Vector3d& end : ends) {
        if (!ways.free(raised(start, height_m), raised(end, height_m))) continue;
        ToolPath path;
        Eigen::Vector3d last = from;
        for (const Eigen::Vector3d& corner :
             {start, raised(start, height_m), raised(end, height_m), end, to}) {
          if ((corner - last).norm() > kSame_m) path.corners.push_back(corner);
          last = corner;
        }
        return path;
      }
    }
  }
  return {{}, ways.blocked()};
}

}  // namespace parallax::harness
