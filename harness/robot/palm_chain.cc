#include "harness/robot/palm_chain.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kFollowRate_hz = 20.0;  // of the correction towards the way, joint by joint
constexpr double kMostFollow = 1.0;      // of the same [rad/s or m/s]
constexpr double kMostRate = 2.0;        // of a joint on the way [rad/s or m/s]
constexpr double kOnWay = 0.02;          // a joint is so far from the way [rad or m]: from here on
constexpr double kOffWay = 0.1;          // the arm slows down; here it waits for the correction
constexpr double kNoWay = 1e-9;          // [m or rad]
constexpr double kArcStep_rad = 0.02;    // between the samples of an arc

/// The same direction, no part larger than `most`.
JointVector bounded(const JointVector& rates, double most) {
  return rates * (most / std::max(most, rates.cwiseAbs().maxCoeff()));
}

}  // namespace

PalmChain::PalmChain(const WorldSpec& spec, const ArmSpec& arm, PhysicsWorld& world)
    : world_(world), arm_(chain_arm(spec, world.layout(), arm)) {
  const WorldLayout& layout = world.layout();
  for (const ChainJoint& joint : arm_.chain.joints()) {
    if (joint.slides) {
      joints_.emplace_back(*layout.find_slider(joint.name));
    } else {
      joints_.emplace_back(*layout.find_hinge(joint.name));
    }
  }
  start_yaw_rad_ = heading_rad(arm_.chain.tool(JointVector::Zero(arm_.chain.size())).linear());
}

JointVector PalmChain::positions() const {
  JointVector q(arm_.chain.size());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const auto* hinge = std::get_if<HingeId>(&joints_[i]);
    q(static_cast<Eigen::Index>(i)) =
        hinge != nullptr ? world_.hinge_angle_rad(*hinge)
                         : world_.slider_position_m(std::get<SliderId>(joints_[i]));
  }
  return q;
}

Eigen::Isometry3d PalmChain::root() const {
  Eigen::Isometry3d X_WR = Eigen::Isometry3d::Identity();
  X_WR.linear() = world_.rotation(arm_.root);
  X_WR.translation() = world_.position(arm_.root);
  return X_WR;
}

double PalmChain::asked_acceleration() const {
  const double asked = along_.asked_acceleration();
  const double rate = along_.asked_velocity();
  const Eigen::Vector3d tool = arm_.chain.tool(positions()).translation();
  switch (mode_) {
    case Mode::kLine:
      return asked;
    case Mode::kTurn:
      return 0.0;  // on the spot
    case Mode::kSwing:
      return tool.norm() * (asked + rate * rate);
    case Mode::kArc:
      return (tool - centre_).head<2>().norm() * (asked + rate * rate);
  }
  return asked;
}

double PalmChain::wrist_rad() const {
  const Eigen::Matrix3d R_RP = world_.rotation(arm_.root).transpose() * world_.rotation(arm_.palm);
  return wrapped(heading_rad(R_RP) - start_yaw_rad_);
}

Eigen::Isometry3d PalmChain::upright(const Eigen::Vector3d& tool_W, double wrist_rad) const {
  Eigen::Isometry3d X_RT = Eigen::Isometry3d::Identity();
  X_RT.linear() =
      Eigen::AngleAxisd(start_yaw_rad_ + wrist_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  X_RT.translation() = root().inverse() * tool_W;
  return X_RT;
}

InverseResult PalmChain::reach(const Eigen::Vector3d& tool_W, double wrist_rad) const {
  return solve_inverse(arm_.chain, upright(tool_W, wrist_rad), positions());
}

void PalmChain::reset() {
  const JointVector q = positions();
  wrist_goal_rad_ = wrist_rad();
  way_ = ChainWay{{q}, 1.0, {}, 1.0};
  from_ = arm_.chain.tool(q);
  mode_ = Mode::kLine;
  length_ = 0.0;
  along_.reset(0.0);
}

void PalmChain::start(ChainWay way, const Eigen::Isometry3d& goal, const Motion& motion) {
  from_ = arm_.chain.tool(way.samples.front());
  const auto error = pose_error(from_, goal);
  const Eigen::Vector3d part = mode_ == Mode::kTurn ? error.tail<3>() : error.head<3>();
  length_ = part.norm();
  ahead_ = length_ > kNoWay ? Eigen::Vector3d(part / length_) : Eigen::Vector3d::Zero();
  way_ = std::move(way);
  along_.reset(0.0);
  if (length_ > kNoWay) along_.move_to(way_.share * length_, motion);
}

void PalmChain::lead_to(const Eigen::Vector3d& target_W, const Motion& motion) {
  const Eigen::Isometry3d goal = upright(target_W, wrist_goal_rad_);
  mode_ = Mode::kLine;
  start(follow_way(arm_.chain, positions(), goal, {}, nullptr), goal, motion);
}

ChainWay PalmChain::arc_way(const JointVector& start, const Eigen::Vector3d& from_W,
                            double wrist_rad, const Eigen::Vector3d& centre_W, double angle_rad,
                            const ChainCheck& check) const {
  // A chord for each small angle, with one sample at its end.
  static constexpr WayOptions kWhole{1.0, 1.0, 0.25};
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(angle_rad) / kArcStep_rad)));
  ChainWay arc{{start}, 1.0, {}, 1.0 / steps};
  for (int i = 1; i <= steps; ++i) {
    const double turned = angle_rad * i / steps;
    const Eigen::Vector3d at = round_vertical(from_W, centre_W, turned);
    const ChainWay chord =
        follow_way(arm_.chain, arc.last(), upright(at, wrist_rad + turned), kWhole, check);
    if (!chord.whole()) {
      arc.share = static_cast<double>(i - 1) / steps;
      arc.fault = chord.fault;
      break;
    }
    arc.samples.push_back(chord.last());
  }
  return arc;
}

void PalmChain::lead_round(const Eigen::Vector3d& centre_W, double angle_rad,
                           const Motion& motion) {
  const JointVector q = positions();
  const Eigen::Vector3d tool_W = root() * arm_.chain.tool(q).translation();
  way_ = arc_way(q, tool_W, wrist_goal_rad_, centre_W, angle_rad, nullptr);
  mode_ = Mode::kArc;
  wrist_goal_rad_ = wrapped(wrist_goal_rad_ + way_.share * angle_rad);
  from_ = arm_.chain.tool(q);
  centre_ = root().inverse() * centre_W;
  arc_rad_ = angle_rad;
  turned_rad_ = 0.0;
  length_ = std::abs(angle_rad);
  along_.reset(0.0);
  if (length_ > kNoWay) along_.move_to(way_.share * length_, motion);
}

void PalmChain::swing_along(ChainWay way, const Motion& motion) {
  mode_ = Mode::kSwing;
  way_ = std::move(way);
  length_ = (way_.last() - way_.samples.front()).cwiseAbs().maxCoeff();
  along_.reset(0.0);
  if (length_ > kNoWay) along_.move_to(length_, motion);
}

void PalmChain::turn_to(double yaw_rad, const Motion& motion) {
  const Eigen::Vector3d tool_W = root() * arm_.chain.tool(positions()).translation();
  wrist_goal_rad_ = wrapped(yaw_rad);
  mode_ = Mode::kTurn;
  const Eigen::Isometry3d goal = upright(tool_W, wrist_goal_rad_);
  start(follow_way(arm_.chain, positions(), goal, {}, nullptr), goal, motion);
}

void PalmChain::aim_wrist(double yaw_rad) { wrist_goal_rad_ = wrapped(yaw_rad); }

void PalmChain::brake() {
  const bool turns = mode_ == Mode::kTurn || mode_ == Mode::kArc;
  if (!along_.at_rest() && turns) wrist_goal_rad_ = wrist_rad();
  along_.brake();
}

double PalmChain::way_done() {
  if (mode_ == Mode::kArc) {
    const Eigen::Vector3d start = from_.translation() - centre_;
    const Eigen::Vector3d now = arm_.chain.tool(positions()).translation() - centre_;
    const double angle = std::atan2(now.y(), now.x()) - std::atan2(start.y(), start.x());
    turned_rad_ += wrapped(angle - turned_rad_);
    return std::copysign(1.0, arc_rad_) * turned_rad_;
  }
  if (mode_ == Mode::kSwing) {
    const JointVector way = way_.last() - way_.samples.front();
    if (length_ <= kNoWay) return 0.0;
    return length_ * way.dot(positions() - way_.samples.front()) / way.squaredNorm();
  }
  const Eigen::Isometry3d now = arm_.chain.tool(positions());
  const auto error = pose_error(from_, now);
  return ahead_.dot(mode_ == Mode::kTurn ? error.tail<3>() : error.head<3>());
}

/// The rates of the joints on a way of which `share_per_s` passes per second. The arm goes slower
/// where a little of the way turns a joint far, or where it is off the way.
JointVector PalmChain::led_rates(double share, double share_per_s, double off) const {
  return bounded(way_.slope(share) * share_per_s, kMostRate) *
         std::clamp((kOffWay - off) / (kOffWay - kOnWay), 0.0, 1.0);
}

void PalmChain::drive_motors() {
  const JointVector q = positions();
  const double done = way_done();
  const double speed = along_.next_velocity(done, 0.0, world_.timestep_s());
  const double share = length_ > kNoWay ? done / length_ : 0.0;
  const JointVector off = way_.at(share) - q;
  // All joints by the same factor: the way back to the way is straight.
  JointVector rates = bounded(kFollowRate_hz * off, kMostFollow);
  if (length_ > kNoWay) rates += led_rates(share, speed / length_, off.cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double rate = rates(static_cast<Eigen::Index>(i));
    if (const auto* hinge = std::get_if<HingeId>(&joints_[i])) {
      world_.set_hinge_motor(*hinge, rate, arm_.strengths[i]);
    } else {
      world_.set_motor(std::get<SliderId>(joints_[i]), rate, arm_.strengths[i]);
    }
  }
}

}  // namespace parallax::harness
