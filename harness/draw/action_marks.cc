#include "harness/draw/action_marks.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "harness/draw/failure_marks.h"
#include "harness/draw/scene_motion.h"
#include "harness/world/arguments.h"

namespace parallax::harness {
namespace {

constexpr double kMoved_m = 0.02;  // less is not worth a mark
constexpr int kRays = 48;          // round the border of the camera's cone

/// The end of a ray of this length, or where it meets the floor.
Eigen::Vector3d end_of_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& ray,
                           double length_m) {
  const double floor_m = ray.z() < 0.0 ? -from.z() / ray.z() : length_m;
  return from + std::min(length_m, std::max(floor_m, 0.0)) * ray;
}

std::string text_of(const State& values, std::string_view name) {
  const auto found = values.find(name);
  const auto* text = found == values.end() ? nullptr : std::get_if<std::string>(&found->second);
  return text == nullptr ? std::string() : *text;
}

std::optional<double> number_of(const State& values, std::string_view name) {
  const auto found = values.find(name);
  return found == values.end() ? std::nullopt : as_number(found->second);
}

/// Where a robot is told to drive: the place that is named, with the coordinates laid over it.
Eigen::Vector3d driving_goal(const WorldSpec& spec, const State& arguments,
                             const Eigen::Vector3d& now) {
  Eigen::Vector3d goal = now;
  for (const PlaceSpec& place : spec.places) {
    if (!place.frame.empty() || place.name != text_of(arguments, "place")) continue;
    goal.head<2>() = place.p_FP.head<2>();
  }
  if (const auto x = number_of(arguments, "target.x")) goal.x() = *x;
  // A robot on a line has no other coordinate.
  const auto y = spec.mobile ? number_of(arguments, "target.y") : std::nullopt;
  if (y) goal.y() = *y;
  return goal;
}

class ActionMarks {
 public:
  ActionMarks(const SeenAction& seen, const WorldSpec& spec) : seen_(seen), spec_(spec) {}

  SceneAction all() {
    const auto& controller = seen_.controller;
    if (controller == "drive" || controller == "going") add_goal();
    if (controller == "detect") add_sought();
    if (controller == "look" || controller == "detect") add_gaze();
    add_tracks();
    add_ghost();
    add_met();
    add_failure_marks(seen_.moments.back().scene, spec_, seen_.arguments, seen_.outcome, action_);
    return std::move(action_);
  }

 private:
  void add_goal() {
    const std::string base = base_body(spec_);
    const Scene& before = seen_.moments.front().scene;
    const auto start = origin_of(before, base);
    if (!start) return;
    SceneGoal goal{*start, driving_goal(spec_, seen_.arguments, *start),
                   seen_.outcome.status == SimStatus::kOk};
    const Eigen::Vector3d way = goal.to_W - goal.from_W;
    const auto free_m = number_of(seen_.outcome.margins, "free_way");
    if (free_m && way.norm() > 0.0) {
      const Eigen::Vector3d moved = std::min(1.0, *free_m / way.norm()) * way;
      for (SceneBox box : before.boxes) {
        if (box.body != base) continue;
        box.box.p_WS += moved;
        action_.meeting.boxes.push_back(std::move(box));
      }
      action_.notes.push_back(fmt::format("red dashes: `{}` where its way ends", base));
    }
    if (!goal.reached) action_.notes.emplace_back("cross: the goal of the straight way");
    action_.goal = std::move(goal);
  }

  void add_gaze() {
    const auto gaze = seen_.gaze;
    if (!gaze || !spec_.mobile) return;
    const Eigen::Vector3d way = gaze->point_W - gaze->camera_W;
    if (way.norm() == 0.0) return;
    const CameraSpec& camera = spec_.mobile->camera;
    const Eigen::Vector3d ahead = way.normalized(), aside = ahead.unitOrthogonal();
    const double half = camera.half_angle_rad;
    // Somewhat beyond what it looks at, and as far as what it looks for.
    double length_m = 1.2 * way.norm();
    for (const SceneSought& sought : action_.sought) {
      length_m = std::max(length_m, (sought.p_W - gaze->camera_W).norm());
    }
    length_m = std::min(length_m, camera.max_range_m);
    SceneGaze out{gaze->camera_W, gaze->point_W, {}};
    for (int i = 0; i < kRays; ++i) {
      const Eigen::AngleAxisd turn(2.0 * std::numbers::pi * i / kRays, ahead);
      const Eigen::Vector3d ray = std::cos(half) * ahead + std::sin(half) * (turn * aside);
      out.border_W.push_back(end_of_ray(gaze->camera_W, ray, length_m));
    }
    action_.gaze = std::move(out);
    action_.notes.push_back(
        fmt::format("yellow: the camera's cone, {:.0f}\xC2\xB0 round its gaze, {:g} to {:g} m",
                    half * 180.0 / std::numbers::pi, camera.min_range_m, camera.max_range_m));
  }

  void add_sought() {
    const std::string kind = text_of(seen_.arguments, "kind");
    const State& state = seen_.after;
    for (const BodySpec& body : spec_.bodies) {
      if (body.kind_name() != kind) continue;
      const auto found = state.find(body.name + ".perceived");
      const auto* is_seen = found == state.end() ? nullptr : std::get_if<bool>(&found->second);
      if (is_seen == nullptr) continue;
      const auto p_W = origin_of(seen_.moments.back().scene, body.name);
      if (p_W) action_.sought.push_back({body.name, *p_W, *is_seen});
    }
    std::sort(action_.sought.begin(), action_.sought.end(),
              [](const SceneSought& a, const SceneSought& b) { return a.body < b.body; });
    for (const auto& sought : action_.sought) {
      action_.notes.push_back(
          fmt::format("{}: {}", sought.body, sought.seen ? "seen (green)" : "not seen (red)"));
    }
  }

  void add_tracks() {
    std::vector<SceneTrack> all;
    for (const SceneMoment& moment : seen_.moments) {
      extend_tracks(moment.scene, base_body(spec_), all);
    }
    std::erase_if(all, [](const SceneTrack& track) { return track.kind == SceneKind::kDrawer; });
    // Where the base drives, the hands go with it.
    const bool drives = std::any_of(all.begin(), all.end(), [&](const SceneTrack& track) {
      return track.kind == SceneKind::kRobot && length_m(track) > kMoved_m;
    });
    for (SceneTrack& track : all) {
      if (length_m(track) <= kMoved_m) continue;
      if (drives && track.kind == SceneKind::kGripper) continue;
      track.points_W = simplified(track.points_W, 0.1 * kMoved_m);
      action_.tracks.push_back(std::move(track));
    }
  }

  void add_ghost() {
    const Scene &first = seen_.moments.front().scene, &last = seen_.moments.back().scene;
    const std::string base = base_body(spec_);
    const auto from = origin_of(first, base), to = origin_of(last, base);
    if (from && to && (*from - *to).norm() > kMoved_m) {
      for (const SceneBox& box : first.boxes) {
        if (box.body == base) action_.ghost.boxes.push_back(box);
      }
      action_.notes.push_back(fmt::format("dashed: `{}` before; line: its way", base));
      return;
    }
    std::vector<SceneTrack> all;
    for (const SceneMoment& moment : seen_.moments) extend_tracks(moment.scene, {}, all);
    const auto half = half_way(all, kMoved_m);
    if (!half) return;
    const SceneMoment& middle = seen_.moments[*half];
    action_.ghost = elsewhere(middle.scene, last, kMoved_m);
    if (action_.ghost.boxes.empty()) return;
    action_.notes.push_back(
        fmt::format("dashed: {:.1f} s into the action; lines: ways", middle.time_s));
  }

  void add_met() {
    if (seen_.outcome.status == SimStatus::kOk) return;
    for (const SceneBox& box : seen_.moments.back().scene.boxes) {
      const bool robot = box.kind == SceneKind::kRobot || box.kind == SceneKind::kGripper;
      if (!robot && seen_.outcome.reason.find("`" + box.body + "`") != std::string::npos) {
        action_.met.push_back(box.body);
      }
    }
    std::sort(action_.met.begin(), action_.met.end());
    action_.met.erase(std::unique(action_.met.begin(), action_.met.end()), action_.met.end());
  }

  const SeenAction& seen_;
  const WorldSpec& spec_;
  SceneAction action_;
};

}  // namespace

SceneAction action_marks(const SeenAction& seen, const WorldSpec& spec) {
  return ActionMarks(seen, spec).all();
}

}  // namespace parallax::harness
