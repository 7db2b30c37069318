#include "harness/draw/scene_frame.h"

#include <algorithm>
#include <limits>

#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

constexpr double kMargin_m = 0.1;
constexpr double kAround_m = 0.25;   // of an action
constexpr double kSmallest_m = 1.0;  // that is shown of a world
constexpr double kPicture = 1.6;  // the way along y over that along x from which x is looked along

/// A box that takes in points.
class FrameBounds {
 public:
  void include(const Eigen::Vector3d& p) {
    low_ = low_.cwiseMin(p);
    high_ = high_.cwiseMax(p);
  }
  void include(const SceneBox& item) {
    const Eigen::Vector3d half = half_extents(item.box.form, item.box.size_m, item.box.R_WS);
    include(item.box.p_WS - half);
    include(item.box.p_WS + half);
  }
  void include(const Scene& scene) {
    for (const SceneBox& item : scene.boxes) include(item);
    for (const SceneArm& arm : scene.arms) {
      include(arm.from_W);
      include(arm.to_W);
    }
  }
  bool empty() const { return low_.x() > high_.x(); }
  const Eigen::Vector3d& low() const { return low_; }
  const Eigen::Vector3d& high() const { return high_; }

 private:
  Eigen::Vector3d low_ = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high_ = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());
};

/// The bounds of all that moved, was aimed at, met or measured, without the bodies as they stand.
FrameBounds bounds_of(const SceneAction& action) {
  FrameBounds bounds;
  for (const SceneTrack& track : action.tracks) {
    for (const Eigen::Vector3d& p : track.points_W) bounds.include(p);
  }
  if (action.goal) {
    bounds.include(action.goal->from_W);
    bounds.include(action.goal->to_W);
  }
  if (action.gaze) {
    bounds.include(action.gaze->camera_W);
    bounds.include(action.gaze->point_W);
  }
  for (const SceneSought& sought : action.sought) bounds.include(sought.p_W);
  for (const SceneMeasure& measure : action.measures) {
    bounds.include(measure.from_W);
    bounds.include(measure.to_W);
  }
  bounds.include(action.ghost);
  bounds.include(action.meeting);
  bounds.include(action.predicted);
  return bounds;
}

bool is_robot(SceneKind kind) { return kind == SceneKind::kRobot || kind == SceneKind::kGripper; }

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Takes in regions and goals, as far as the frame's own size beyond it.
void widen(SceneFrame& frame, const std::vector<Picture>& pictures, const RegionMap* regions) {
  const Eigen::Vector3d size = frame.high - frame.low;
  const SceneFrame limit{frame.low - size, frame.high + size};
  const auto include = [&](Eigen::Index i, double value) {
    frame.low[i] = std::min(frame.low[i], std::max(value, limit.low[i]));
    frame.high[i] = std::max(frame.high[i], std::min(value, limit.high[i]));
  };
  for (const Picture& picture : pictures) {
    if (!picture.action.goal) continue;
    for (const Eigen::Index i : {0, 1}) include(i, picture.action.goal->to_W[i]);
  }
  if (regions == nullptr) return;
  for (const Region& region : regions->regions()) {
    if (!region.frame.empty()) continue;
    for (const RegionAxis axis : {RegionAxis::kX, RegionAxis::kY}) {
      if (!region.on(axis)) continue;
      include(static_cast<Eigen::Index>(axis), region.on(axis)->lower);
      include(static_cast<Eigen::Index>(axis), region.on(axis)->upper);
    }
  }
}

}  // namespace

SceneFrame frame_around(const std::vector<Picture>& pictures, const RegionMap* regions) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  SceneFrame frame{Eigen::Vector3d::Constant(kInfinity), Eigen::Vector3d::Constant(-kInfinity)};
  const auto include = [&frame](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    frame = {frame.low.cwiseMin(low), frame.high.cwiseMax(high)};
  };
  const auto include_scene = [&](const Scene& scene) {
    for (const SceneBox& item : scene.boxes) {
      const Eigen::Vector3d half = half_extents(item.box.form, item.box.size_m, item.box.R_WS);
      include(item.box.p_WS - half, item.box.p_WS + half);
    }
    for (const SceneArm& arm : scene.arms) include(arm.from_W, arm.from_W);
  };
  for (const Picture& picture : pictures) {
    include_scene(picture.scene);
    include_scene(picture.action.ghost);
    include_scene(picture.action.meeting);
    for (const SceneTrack& track : picture.action.tracks) {
      for (const Eigen::Vector3d& p : track.points_W) include(p, p);
    }
  }
  if (frame.low.x() > frame.high.x()) frame = SceneFrame{};  // no bodies
  include({frame.low.x(), frame.low.y(), 0.0}, {frame.high.x(), frame.high.y(), 0.0});
  widen(frame, pictures, regions);
  frame.low -= kMargin_m * Eigen::Vector3d::Ones();
  frame.high += kMargin_m * Eigen::Vector3d::Ones();
  return frame;
}

SceneFrame frame_of_both(const SceneFrame& a, const SceneFrame& b) {
  return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
}

std::set<std::string> taking_part(const Picture& picture) {
  const SceneAction& action = picture.action;
  std::set<std::string> out(action.met.begin(), action.met.end());
  out.insert(action.differing.begin(), action.differing.end());
  for (const SceneTrack& track : action.tracks) out.insert(track.name);
  for (const SceneSought& sought : action.sought) out.insert(sought.body);
  for (const SceneBox& item : action.ghost.boxes) out.insert(item.body);
  // Before anything is done, whatever could.
  const bool nothing_done = bounds_of(action).empty() && out.empty();
  for (const SceneBox& item : picture.scene.boxes) {
    if (is_robot(item.kind) || (nothing_done && item.kind != SceneKind::kFurniture)) {
      out.insert(item.body);
    }
  }
  return out;
}

SceneFrame action_frame(const Picture& picture, const RegionMap& regions) {
  FrameBounds bounds = bounds_of(picture.action);
  const bool nothing_done = bounds.empty();
  for (const SceneBox& item : picture.scene.boxes) {
    const bool moves = item.kind == SceneKind::kItem || item.kind == SceneKind::kDrawer;
    const bool differs = moves && has(picture.action.differing, item.body);
    if (is_robot(item.kind) || differs || (nothing_done && moves)) bounds.include(item);
    // Furniture that was met is left out: of a long piece the part near the action is enough.
    if (moves && has(picture.action.met, item.body)) bounds.include(item);
  }
  for (const SceneArm& arm : picture.scene.arms) {
    bounds.include(arm.from_W);
    bounds.include(arm.to_W);
  }
  if (bounds.empty()) return frame_around({picture}, nullptr);
  SceneFrame frame{bounds.low(), bounds.high()};
  for (const std::string& name : picture.action.predicted_regions) {
    const Region* region = regions.find(name);
    if (region == nullptr || !region->frame.empty()) continue;
    for (const RegionAxis axis : {RegionAxis::kX, RegionAxis::kY}) {
      const auto& interval = region->on(axis);
      if (!interval) continue;
      // Its nearest part: a region may be as large as the world.
      const auto i = static_cast<Eigen::Index>(axis);
      const double near = std::clamp(frame.low[i], interval->lower, interval->upper);
      const double far = std::clamp(frame.high[i], interval->lower, interval->upper);
      frame.low[i] = std::min({frame.low[i], near, far});
      frame.high[i] = std::max({frame.high[i], near, far});
    }
  }
  for (const Eigen::Index i : {0, 1}) {
    const double room = std::max(kAround_m, 0.5 * (kSmallest_m - (frame.high[i] - frame.low[i])));
    frame.low[i] -= room;
    frame.high[i] += room;
  }
  frame.low.z() = std::min(0.0, frame.low.z()) - kMargin_m;
  frame.high.z() += kMargin_m;
  return frame;
}

ViewKind side_of(const Picture& picture) {
  const FrameBounds bounds = bounds_of(picture.action);
  if (bounds.empty()) return ViewKind::kSide;
  const Eigen::Vector3d size = bounds.high() - bounds.low();
  return size.y() > kPicture * size.x() ? ViewKind::kFront : ViewKind::kSide;
}

}  // namespace parallax::harness
