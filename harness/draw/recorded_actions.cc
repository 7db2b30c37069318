#include "harness/draw/recorded_actions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <variant>

#include "harness/recording/scene_json.h"
#include "harness/robot/motion_recorder.h"
#include "harness/world/arguments.h"
#include "harness/world/shapes.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {
namespace {

/// Half a step of the recording's time, and what sums of times are off by.
constexpr double kSameTime_s = 0.75 * kFrameTime_s;
/// Three successive moments from a recorder span more than this: its steps, and the end of the
/// action.
constexpr double kDense_s = 0.04;
/// A body farther away than this was not recorded where it was observed.
constexpr double kRecorded_m = 2e-3;
/// If the recorded camera points farther off the target than this, the gaze went elsewhere.
constexpr double kSameGaze_rad = 0.01;

Eigen::Vector3d vector_of(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

Eigen::Matrix3d matrix_of(const std::array<double, 4>& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

/// The middle of the corners need not be the place of the shape.
Probe hull_probe(const RecordedShape& shape, const Pose& at) {
  std::vector<Eigen::Vector3d> corners;
  for (const auto& corner : shape.corners) corners.push_back(vector_of(corner));
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  std::string why;
  auto hull = hull_with(std::move(corners), shape.faces, middle, why);
  Probe out{Eigen::Vector3d::Zero(), vector_of(at.p), matrix_of(at.q)};
  if (!hull) return out;  // of another simulator, and not convex: a point
  out.p_WS += out.R_WS * middle;
  out.size_m = hull->size_m;
  out.form = ShapeForm::kHull;
  out.hull = std::make_shared<const ConvexHull>(std::move(*hull));
  return out;
}

Probe probe_of(const RecordedShape& shape, const Pose& at) {
  Probe out{vector_of(shape.size), vector_of(at.p), matrix_of(at.q)};
  if (shape.kind == ShapeKind::kBox) return out;
  if (shape.kind == ShapeKind::kHull) return hull_probe(shape, at);
  out.form = shape.kind == ShapeKind::kSphere     ? ShapeForm::kSphere
             : shape.kind == ShapeKind::kCylinder ? ShapeForm::kCylinder
                                                  : ShapeForm::kCapsule;
  out.size_m = round_size_m(out.form, shape.size[0], shape.size[1]);
  return out;
}

SceneKind shown_kind(BodyKind kind) {
  switch (kind) {
    case BodyKind::kDrawer:
      return SceneKind::kDrawer;
    case BodyKind::kRobot:
      return SceneKind::kRobot;
    case BodyKind::kGripper:
      return SceneKind::kGripper;
    case BodyKind::kItem:
      return SceneKind::kItem;
    case BodyKind::kFurniture:
    case BodyKind::kCamera:
      break;
  }
  return SceneKind::kFurniture;
}

std::optional<double> observed_number(const State& state, const std::string& name) {
  const auto found = state.find(name);
  return found == state.end() ? std::nullopt : as_number(found->second);
}

std::string named_place(const State& arguments) {
  const auto found = arguments.find("place");
  const auto* name = found == arguments.end() ? nullptr : std::get_if<std::string>(&found->second);
  return name == nullptr ? std::string() : *name;
}

}  // namespace

std::string unlike_world(const Recording& recording, const WorldSpec& spec) {
  std::string why;
  // As it reads once it was written.
  const auto scene = scene_from_text(scene_text(recorded_scene(spec, lay_out(spec))), why);
  if (scene && *scene == recording.scene) return {};
  return "its bodies are not those of the scenario's world";
}

RecordedActions::RecordedActions(const Recording& recording, const WorldSpec& spec)
    : recording_(recording), spec_(spec), playback_(recording) {
  is_ahead_ = playback_.next();
  read_frame();
  observe(0);
  scene_ = shown();
}

void RecordedActions::read_frame() {
  poses_.resize(recording_.scene.bodies.size());
  for (std::size_t i = 0; i < poses_.size(); ++i) poses_[i] = playback_.pose_of(i);
  if (is_ahead_) is_ahead_ = playback_.next();
}

void RecordedActions::observe(std::size_t timepoint) {
  if (timepoint >= recording_.observations.size()) return;
  const State& state = recording_.observations[timepoint];
  const auto& bodies = recording_.scene.bodies;
  const std::string base = this->base();
  std::set<std::size_t> done;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i].moves) continue;
    const auto leader = bodies[i].on.value_or(i);
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    bool is_observed = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string name = bodies[i].name == base ? "robot" : bodies[i].name;
      const auto at = observed_number(state, name + "." + "xyz"[axis]);
      if (!at) continue;
      shift[static_cast<Eigen::Index>(axis)] = *at - poses_[i].p[axis];
      is_observed = true;
    }
    if (!is_observed || shift.norm() > kRecorded_m || !done.insert(leader).second) continue;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (!bodies[k].moves || bodies[k].on.value_or(k) != leader) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        poses_[k].p[axis] += shift[static_cast<Eigen::Index>(axis)];
      }
    }
  }
}

/// The body that `robot.x` is about. Other simulators call it by its name, or `robot`.
std::string RecordedActions::base() const {
  auto named = base_body(spec_);
  if (!named.empty()) return named;
  const auto& bodies = recording_.scene.bodies;
  const bool has_robot = std::any_of(bodies.begin(), bodies.end(),
                                     [](const RecordedBody& body) { return body.name == "robot"; });
  return has_robot ? "robot" : std::string();
}

Scene RecordedActions::shown() const {
  Scene scene;
  const auto& bodies = recording_.scene.bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (const auto& shape : bodies[i].shapes) {
      const Pose at = composed(poses_[i], shape.pose);
      scene.boxes.push_back({bodies[i].name, shown_kind(bodies[i].kind), probe_of(shape, at),
                             vector_of(poses_[i].p)});
    }
  }
  scene.base = base();
  for (const auto& arm : recording_.scene.arms) {
    scene.arms.push_back({arm.name, vector_of(point_of(poses_[arm.from], arm.shoulder)),
                          vector_of(poses_[arm.to].p)});
  }
  return scene;
}

std::optional<Eigen::Vector3d> RecordedActions::place_in_world(const PlaceSpec& place) const {
  if (place.frame.empty()) return place.p_FP;
  const auto& bodies = recording_.scene.bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].name != place.frame) continue;
    return vector_of(point_of(poses_[i], {place.p_FP.x(), place.p_FP.y(), place.p_FP.z()}));
  }
  return std::nullopt;
}

void RecordedActions::look(const std::string& controller, const State& arguments,
                           const Outcome& outcome) {
  // A refused look leaves the camera as it was.
  if (controller != "look" || outcome.status == SimStatus::kFailed) return;
  const auto name = named_place(arguments);
  for (const PlaceSpec& place : spec_.places) {
    if (place.name == name) {
      looked_at_ = place;
      return;
    }
  }
  PlaceSpec point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto given = observed_number(arguments, std::string("target.") + "xyz"[axis]);
    point.p_FP[static_cast<Eigen::Index>(axis)] = given.value_or(0.0);
  }
  looked_at_ = point;
}

/// Where the recorded camera points at what it was last told to look at; it is dropped where the
/// robot has gone too far since.
std::optional<Gaze> RecordedActions::gaze() const {
  const auto& bodies = recording_.scene.bodies;
  const auto camera = std::find_if(bodies.begin(), bodies.end(), [](const RecordedBody& body) {
    return body.kind == BodyKind::kCamera;
  });
  const auto point_W = looked_at_ ? place_in_world(*looked_at_) : std::nullopt;
  if (camera == bodies.end() || !point_W) return std::nullopt;
  const Pose& at = poses_[static_cast<std::size_t>(camera - bodies.begin())];
  const Eigen::Vector3d way = *point_W - vector_of(at.p), ahead = matrix_of(at.q).col(0);
  if (std::atan2(way.cross(ahead).norm(), way.dot(ahead)) > kSameGaze_rad) return std::nullopt;
  return Gaze{vector_of(at.p), *point_W};
}

Outcome RecordedActions::act(const std::string& controller, const State& arguments) {
  action_ = SceneAction{};
  seen_ = SeenAction{controller, arguments, {}, {}, {}, {}};
  auto& moments = seen_.moments;
  moments.push_back({0.0, scene_});
  Outcome& outcome = seen_.outcome;
  if (next_ == recording_.events.size()) {
    outcome.status = SimStatus::kLost;
    outcome.reason = "nothing more was recorded";
    return outcome;
  }
  const RecordedEvent& event = recording_.events[next_++];
  outcome.status = sim_status_from(event.status);
  outcome.reason = event.reason;
  outcome.sim_time_s = event.end_s - event.begin_s;
  outcome.margins = event.margins;
  if (outcome.status == SimStatus::kLost) return outcome;
  while (is_ahead_ && playback_.time_s() <= event.end_s + kSameTime_s) {
    const double time_s = playback_.time_s() - event.begin_s;
    read_frame();
    // If frames come more often than a recorder writes them, only some are kept. Which ones follows
    // from the time that the action took.
    const bool is_dense =
        moments.size() > 2 && time_s - moments[moments.size() - 2].time_s < kDense_s;
    if (is_dense) {
      moments.back() = {time_s, shown()};
    } else {
      moments.push_back({time_s, shown()});
    }
  }
  observe(next_);
  scene_ = shown();
  moments.push_back({outcome.sim_time_s, scene_});
  look(controller, arguments, outcome);
  seen_.gaze = gaze();
  if (next_ < recording_.observations.size()) seen_.after = recording_.observations[next_];
  action_ = action_marks(seen_, spec_);
  return outcome;
}

}  // namespace parallax::harness
