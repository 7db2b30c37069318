#include "harness/draw/action_recorder.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "harness/world/arguments.h"

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

constexpr double kEvery_s = 0.05;
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

ActionRecorder::ActionRecorder(OdeSimulator& simulator, const WorldSpec& spec)
    : simulator_(simulator), spec_(spec) {
  simulator_.watch(
      [](void* context, double time_s, const OdeSimulator&) {
        auto& recorder = *static_cast<ActionRecorder*>(context);
        if (time_s - recorder.moments_.back().time_s >= kEvery_s) recorder.take(time_s);
      },
      this);
}

ActionRecorder::~ActionRecorder() { simulator_.watch(nullptr, nullptr); }

void ActionRecorder::take(double time_s) { moments_.push_back({time_s, scene()}); }

Outcome ActionRecorder::act(const std::string& controller, const State& arguments,
                            double time_limit_s) {
  moments_.clear();
  action_ = SceneAction{};
  take(0.0);
  Outcome outcome = simulator_.act(controller, arguments, time_limit_s);
  if (outcome.status == SimStatus::kLost) return outcome;  // no position means anything
  take(outcome.sim_time_s);
  if (controller == "drive" || controller == "going") add_goal(arguments, outcome);
  if (controller == "detect") add_sought(arguments);
  if (controller == "look" || controller == "detect") add_gaze();
  add_tracks();
  add_ghost();
  add_met(outcome);
  add_failure_marks(moments_.back().scene, spec_, arguments, outcome, action_);
  return outcome;
}

void ActionRecorder::add_goal(const State& arguments, const Outcome& outcome) {
  const std::string base = base_body(spec_);
  const Scene& before = moments_.front().scene;
  const auto start = origin_of(before, base);
  if (!start) return;
  SceneGoal goal{*start, driving_goal(spec_, arguments, *start), outcome.status == SimStatus::kOk};
  const Eigen::Vector3d way = goal.to_W - goal.from_W;
  const auto free_m = number_of(outcome.margins, "free_way");
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

void ActionRecorder::add_gaze() {
  const auto gaze = simulator_.gaze();
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

void ActionRecorder::add_sought(const State& arguments) {
  const std::string kind = text_of(arguments, "kind");
  const State state = simulator_.state();
  for (const BodySpec& body : spec_.bodies) {
    if (body.kind_name() != kind) continue;
    const auto found = state.find(body.name + ".perceived");
    if (found == state.end()) continue;
    const auto p_W = origin_of(moments_.back().scene, body.name);
    if (p_W) action_.sought.push_back({body.name, *p_W, std::get<bool>(found->second)});
  }
  std::sort(action_.sought.begin(), action_.sought.end(),
            [](const SceneSought& a, const SceneSought& b) { return a.body < b.body; });
  for (const auto& sought : action_.sought) {
    action_.notes.push_back(
        fmt::format("{}: {}", sought.body, sought.seen ? "seen (green)" : "not seen (red)"));
  }
}

void ActionRecorder::add_tracks() {
  std::vector<SceneTrack> all;
  for (const Moment& moment : moments_) extend_tracks(moment.scene, base_body(spec_), all);
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

void ActionRecorder::add_ghost() {
  const Scene &first = moments_.front().scene, &last = moments_.back().scene;
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
  for (const Moment& moment : moments_) extend_tracks(moment.scene, {}, all);
  const auto half = half_way(all, kMoved_m);
  if (!half) return;
  const Moment& middle = moments_[*half];
  action_.ghost = elsewhere(middle.scene, last, kMoved_m);
  if (action_.ghost.boxes.empty()) return;
  action_.notes.push_back(
      fmt::format("dashed: {:.1f} s into the action; lines: ways", middle.time_s));
}

void ActionRecorder::add_met(const Outcome& outcome) {
  if (outcome.status == SimStatus::kOk) return;
  for (const SceneBox& box : moments_.back().scene.boxes) {
    const bool robot = box.kind == SceneKind::kRobot || box.kind == SceneKind::kGripper;
    if (!robot && outcome.reason.find("`" + box.body + "`") != std::string::npos) {
      action_.met.push_back(box.body);
    }
  }
  std::sort(action_.met.begin(), action_.met.end());
  action_.met.erase(std::unique(action_.met.begin(), action_.met.end()), action_.met.end());
}

}  // namespace parallax::harness
