#include "harness/robot/motion_recorder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

std::array<double, 3> listed(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

std::array<double, 4> quaternion_of(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return {q.w(), q.x(), q.y(), q.z()};
}

Eigen::Matrix3d turn_about_z(double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

std::array<double, 4> yaw_quaternion(double yaw_rad) {
  return {std::cos(0.5 * yaw_rad), 0.0, 0.0, std::sin(0.5 * yaw_rad)};
}

RecordedShape recorded_shape(const BodyShape& shape) {
  RecordedShape out;
  const double radius_m = 0.5 * shape.size_m.x(), length_m = shape.size_m.z();
  switch (shape.form) {
    case ShapeForm::kBox:
      out = {ShapeKind::kBox, listed(shape.size_m), {}};
      break;
    case ShapeForm::kSphere:
      out = {ShapeKind::kSphere, {radius_m, 0.0, 0.0}, {}};
      break;
    case ShapeForm::kCylinder:
      out = {ShapeKind::kCylinder, {radius_m, length_m, 0.0}, {}};
      break;
    case ShapeForm::kCapsule:
      out = {ShapeKind::kCapsule, {radius_m, length_m - 2.0 * radius_m, 0.0}, {}};
      break;
    case ShapeForm::kHull:
      out.kind = ShapeKind::kHull;
      for (const auto& corner : shape.hull->vertices) out.corners.push_back(listed(corner));
      out.faces = shape.hull->faces;
      break;
  }
  const bool upright = shape.roll_rad == 0.0 && shape.pitch_rad == 0.0;
  out.pose = {listed(shape.p_BS),
              upright ? yaw_quaternion(shape.yaw_rad) : quaternion_of(shape_rotation(shape))};
  return out;
}

/// X_AB, by default, of two bodies that are given in the world.
Pose seen_from(const BodySpec& a, const BodySpec& b) {
  const Eigen::Vector3d p = turn_about_z(a.yaw_rad).transpose() * (b.p_WB - a.p_WB);
  return {listed(p), yaw_quaternion(b.yaw_rad - a.yaw_rad)};
}

BodyKind kind_in_recordings(const WorldSpec& spec, const WorldLayout& layout, BodyId id) {
  const auto index = id.index();
  if (!layout.link_of[index]) return BodyKind::kFurniture;
  if (layout.is_free[index]) return BodyKind::kItem;
  const auto base = layout.find_body(base_body(spec));
  if (!base || layout.assembly_of[index] != layout.assembly_of[base->index()]) {
    return BodyKind::kDrawer;
  }
  const auto& name = layout.bodies[id].name;
  for (const auto& gripper : grippers(spec)) {
    if (gripper.near_pad_body == name || gripper.far_pad_body == name) return BodyKind::kGripper;
  }
  return BodyKind::kRobot;
}

/// The torso where it carries the shoulders, else the base.
std::optional<BodyId> shoulders_on(const MobileRobotSpec& robot, const WorldLayout& layout) {
  if (const auto torso = layout.find_slider(robot.torso_joint)) {
    return layout.find_body(layout.sliders[*torso].child);
  }
  return layout.find_body(robot.base_body);
}

void add_robot(const MobileRobotSpec& robot, const WorldLayout& layout, RecordedScene& scene) {
  const auto base = layout.find_body(robot.base_body);
  const auto on = shoulders_on(robot, layout);
  if (!base || !on) return;
  const auto& base_spec = layout.bodies[*base];
  const auto& on_spec = layout.bodies[*on];
  for (const auto& arm : robot.arms) {
    const auto palm = layout.find_body(arm.palm_body);
    if (!palm || !arm.chain.empty()) continue;
    const Eigen::Vector3d shoulder_W = base_spec.p_WB + turn_about_z(base_spec.yaw_rad) * arm.p_BS;
    const Eigen::Vector3d in_body =
        turn_about_z(on_spec.yaw_rad).transpose() * (shoulder_W - on_spec.p_WB);
    scene.arms.push_back(
        {arm.name, on->index(), palm->index(), listed(in_body), arm.min_reach_m, arm.max_reach_m});
  }
  const auto& camera = robot.camera;
  scene.camera = {camera.half_angle_rad, camera.min_range_m, camera.max_range_m};
  RecordedBody body;
  body.name = "camera of " + robot.base_body;
  body.kind = BodyKind::kCamera;
  body.moves = true;
  scene.bodies.push_back(std::move(body));
}

/// Looking from one point at another: the x axis along the gaze, the y axis level.
Pose looking(const Eigen::Vector3d& from, const Eigen::Vector3d& at) {
  const Eigen::Vector3d way = at - from;
  const double length = way.norm();
  if (!(length > 1e-9)) return {listed(from), {1.0, 0.0, 0.0, 0.0}};
  const double yaw = std::atan2(way.y(), way.x());
  const double pitch = std::asin(std::clamp(-way.z() / length, -1.0, 1.0));
  const Eigen::Matrix3d R =
      turn_about_z(yaw) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return {listed(from), quaternion_of(R)};
}

}  // namespace

RecordedScene recorded_scene(const WorldSpec& spec, const WorldLayout& layout) {
  RecordedScene scene;
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const auto id = layout.bodies.id_at(i);
    const auto& given = layout.bodies[id];
    RecordedBody body;
    body.name = given.name;
    body.kind = kind_in_recordings(spec, layout, id);
    for (const auto& shape : given.shapes) {
      body.shapes.push_back(recorded_shape(shape));
    }
    if (const auto link = layout.link_of[i]) {
      body.moves = true;
      const auto leader = layout.links[*link].members.front();
      if (leader != id) {
        body.on = leader.index();
        body.pose = seen_from(layout.bodies[leader], given);
      }
    } else {
      body.pose = {listed(given.p_WB), yaw_quaternion(given.yaw_rad)};
    }
    scene.bodies.push_back(std::move(body));
  }
  if (spec.mobile) {
    for (const auto& arm : spec.mobile->arms) scene.grippers.push_back(arm.name);
    add_robot(*spec.mobile, layout, scene);
  } else if (!grippers(spec).empty()) {
    scene.grippers.emplace_back("gripper");
  }
  return scene;
}

MotionRecorder::MotionRecorder(const WorldSpec& spec, const PhysicsWorld& world,
                               const GraspMonitor& grasp, const MobileRobot* robot,
                               const Perception* perception)
    : world_(world),
      grasp_(grasp),
      robot_(robot),
      perception_(perception),
      scene_(recorded_scene(spec, world.layout())),
      grippers_(scene_.grippers.size()) {
  const auto moving = scene_.moving();
  for (const auto body : moving) {
    if (body < world.layout().bodies.size()) leaders_.push_back(world.layout().bodies.id_at(body));
  }
  poses_.resize(moving.size());
  grips_.resize(moving.size() * grippers_);
  writer_ = MotionWriter({moving.size(), grippers_});
}

void MotionRecorder::set_interval(double interval_s) {
  every_ = interval_s > 0.0
               ? std::max<std::int64_t>(1, std::llround(interval_s / world_.timestep_s()))
               : 0;
}

void MotionRecorder::begin() {
  if (every_ == 0) return;
  steps_ = 0;
  added_ = -1;
  poses_.assign(poses_.size(), Pose());
  writer_.begin();
  add();
}

RecordedMotion MotionRecorder::take() {
  if (every_ == 0) return {};
  if (added_ != steps_) add();
  return {writer_.take(), writer_.fault()};
}

void MotionRecorder::fill_grips(BodyId id, std::size_t index) {
  if (!world_.layout().is_free[id.index()]) return;
  const auto& touch = world_.touch(id);
  for (std::size_t g = 0; g < grippers_; ++g) {
    const auto gripper = static_cast<std::uint32_t>(g);
    unsigned grip = 0;
    if (touch.near_pad(gripper)) grip |= kGripNearPad;
    if (touch.far_pad(gripper)) grip |= kGripFarPad;
    if (grasp_.held_by(gripper, id)) grip |= kGripHeld;
    // Support matters only for a body that a gripper touches; for others the place tells as much.
    if (grip != 0 && touch.support) grip |= kGripSupported;
    grips_[index * grippers_ + g] = static_cast<std::uint8_t>(grip);
  }
}

void MotionRecorder::add() {
  added_ = steps_;
  for (std::size_t i = 0; i < leaders_.size(); ++i) {
    const auto id = leaders_[i];
    poses_[i] = {listed(world_.position(id)), quaternion_of(world_.rotation(id))};
    if (grippers_ > 0) fill_grips(id, i);
  }
  if (scene_.camera && robot_ != nullptr && perception_ != nullptr) {
    const auto camera = robot_->camera();
    const auto gaze = perception_->line_of_sight();
    poses_.back() = looking(camera, gaze ? gaze->point_W : camera + robot_->base().heading());
  }
  writer_.add(static_cast<double>(steps_) * world_.timestep_s(), poses_, grips_);
}

}  // namespace parallax::harness
