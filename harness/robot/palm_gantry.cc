#include "harness/robot/palm_gantry.h"

#include <algorithm>

#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kWristRate_hz = 20.0;         // of the correction while the wrist turns on an arc
constexpr double kMostWristRate_rad_s = 0.25;  // of the same

}  // namespace

PalmGantry::PalmGantry(const ArmSpec& spec, PhysicsWorld& world)
    : world_(world), gantry_(*world.layout().find_gantry(spec.joint)) {}

void PalmGantry::reset() {
  arc_.reset();
  line_.reset(world_.gantry_position_m(gantry_));
  wrist_unwrapped_rad_ = world_.gantry_yaw_rad(gantry_);
  wrist_.reset(wrist_unwrapped_rad_);
}

Eigen::Vector3d PalmGantry::in_gantry(const Eigen::Vector3d& way_W) const {
  const JointSpec& joint = world_.layout().gantries[gantry_];
  const BodyId parent = *world_.layout().find_body(joint.parent);
  return world_.rotation(parent).transpose() * way_W;
}

void PalmGantry::lead_to(const Eigen::Vector3d& tool_W, const Eigen::Vector3d& target_W,
                         const Motion& motion) {
  end_arc();
  const Eigen::Vector3d now = world_.gantry_position_m(gantry_);
  line_.move_to(now, now + in_gantry(target_W - tool_W), motion);
}

void PalmGantry::lead_round(const Eigen::Vector3d& tool_W, const Eigen::Vector3d& centre_W,
                            double angle_rad, const Motion& motion) {
  const Eigen::Vector3d now = world_.gantry_position_m(gantry_);
  arc_wrist_rad_ = wrist_unwrapped_rad_;
  arc_.emplace().move_round(now, now + in_gantry(centre_W - tool_W), angle_rad, motion);
}

void PalmGantry::turn_to(double yaw_rad, const Motion& motion) {
  end_arc();
  wrist_.move_to(wrist_unwrapped_rad_ + wrapped(yaw_rad - wrist_unwrapped_rad_), motion);
}

void PalmGantry::end_arc() {
  if (!arc_) return;
  arc_.reset();
  line_.reset(world_.gantry_position_m(gantry_));
  wrist_.reset(wrist_unwrapped_rad_);
}

void PalmGantry::brake() {
  if (arc_) arc_->brake();
  line_.brake();
  wrist_.brake();
}

bool PalmGantry::at_rest() const {
  return arc_ ? arc_->at_rest() : line_.at_rest() && wrist_.at_rest();
}

void PalmGantry::drive_motors() {
  const double step_s = world_.timestep_s();
  wrist_unwrapped_rad_ += wrapped(world_.gantry_yaw_rad(gantry_) - wrist_unwrapped_rad_);
  const Eigen::Vector3d now = world_.gantry_position_m(gantry_);
  if (arc_) {
    const Eigen::Vector3d velocity = arc_->next_velocity(now, step_s);
    const double behind_rad = arc_wrist_rad_ + arc_->turned_rad() - wrist_unwrapped_rad_;
    const double correction =
        std::clamp(kWristRate_hz * behind_rad, -kMostWristRate_rad_s, kMostWristRate_rad_s);
    world_.set_gantry(gantry_, velocity, arc_->rate_rad_s() + correction);
    return;
  }
  const Eigen::Vector3d velocity = line_.next_velocity(now, step_s);
  world_.set_gantry(gantry_, velocity, wrist_.next_velocity(wrist_unwrapped_rad_, 0.0, step_s));
}

}  // namespace parallax::harness
