#include "harness/draw/scene_motion.h"

#include <algorithm>
#include <utility>

namespace parallax::harness {
namespace {

/// How far `p` lies from the stretch between `a` and `b` [m].
double off_m(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d way = b - a;
  const double square = way.squaredNorm();
  const double share = square > 0.0 ? std::clamp((p - a).dot(way) / square, 0.0, 1.0) : 0.0;
  return (p - a - share * way).norm();
}

/// The point between `first` and `last` that lies farthest from the line between them.
std::pair<std::size_t, double> farthest(const std::vector<Eigen::Vector3d>& points,
                                        std::size_t first, std::size_t last) {
  std::pair<std::size_t, double> found{first, 0.0};
  for (std::size_t i = first + 1; i < last; ++i) {
    const double distance_m = off_m(points[i], points[first], points[last]);
    if (distance_m > found.second) found = {i, distance_m};
  }
  return found;
}

void extend(std::vector<SceneTrack>& tracks, const std::string& name, SceneKind kind,
            const Eigen::Vector3d& p_W) {
  const auto found = std::find_if(tracks.begin(), tracks.end(), [&](const SceneTrack& track) {
    return track.name == name && track.kind == kind;
  });
  if (found != tracks.end()) {
    found->points_W.push_back(p_W);
  } else {
    tracks.push_back({name, kind, {p_W}});
  }
}

/// Half way between the pads of a robot on a line.
std::optional<Eigen::Vector3d> middle_of_pads(const Scene& scene) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const SceneBox& item : scene.boxes) {
    if (item.kind != SceneKind::kGripper) continue;
    sum += item.box.p_WS;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

}  // namespace

void extend_tracks(const Scene& scene, const std::string& base, std::vector<SceneTrack>& tracks) {
  std::string last;
  for (const SceneBox& item : scene.boxes) {
    if (item.body == last) continue;  // another box of the same body
    last = item.body;
    if (item.body == base) extend(tracks, item.body, SceneKind::kRobot, item.origin_W);
    const bool moves = item.kind == SceneKind::kItem || item.kind == SceneKind::kDrawer;
    if (moves) extend(tracks, item.body, item.kind, item.origin_W);
  }
  for (const SceneArm& arm : scene.arms) {
    extend(tracks, arm.name, SceneKind::kGripper, arm.to_W);
  }
  if (!scene.arms.empty()) return;
  if (const auto middle = middle_of_pads(scene)) {
    extend(tracks, "gripper", SceneKind::kGripper, *middle);
  }
}

double length_m(const SceneTrack& track) {
  double sum = 0.0;
  for (std::size_t i = 1; i < track.points_W.size(); ++i) {
    sum += (track.points_W[i] - track.points_W[i - 1]).norm();
  }
  return sum;
}

std::vector<Eigen::Vector3d> simplified(const std::vector<Eigen::Vector3d>& points,
                                        double tolerance_m) {
  if (points.size() < 3) return points;
  std::vector<bool> kept(points.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    const auto [middle, distance_m] = farthest(points, first, last);
    if (distance_m <= tolerance_m) continue;
    kept[middle] = true;
    open.emplace_back(first, middle);
    open.emplace_back(middle, last);
  }
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (kept[i]) out.push_back(points[i]);
  }
  return out;
}

std::optional<std::size_t> half_way(const std::vector<SceneTrack>& tracks, double moved_m) {
  const SceneTrack* longest = nullptr;
  for (const bool hands : {false, true}) {
    for (const SceneTrack& track : tracks) {
      const bool counts = hands
                              ? track.kind == SceneKind::kGripper
                              : track.kind == SceneKind::kItem || track.kind == SceneKind::kDrawer;
      if (!counts || length_m(track) <= moved_m) continue;
      if (longest == nullptr || length_m(track) > length_m(*longest)) longest = &track;
    }
    if (longest != nullptr) break;
  }
  if (longest == nullptr) return std::nullopt;
  const auto& points = longest->points_W;
  std::size_t i = 0;
  for (double left_m = 0.5 * length_m(*longest); left_m > 0.0 && i + 1 < points.size(); ++i) {
    left_m -= (points[i + 1] - points[i]).norm();
  }
  return i;
}

Scene elsewhere(const Scene& scene, const Scene& later, double moved_m) {
  Scene out;
  for (std::size_t i = 0; i < scene.boxes.size() && i < later.boxes.size(); ++i) {
    const SceneBox &then = scene.boxes[i], &now = later.boxes[i];
    if ((then.box.p_WS - now.box.p_WS).norm() > moved_m) out.boxes.push_back(then);
  }
  for (std::size_t i = 0; i < scene.arms.size() && i < later.arms.size(); ++i) {
    const SceneArm &then = scene.arms[i], &now = later.arms[i];
    if ((then.to_W - now.to_W).norm() > moved_m) out.arms.push_back(then);
  }
  return out;
}

}  // namespace parallax::harness
