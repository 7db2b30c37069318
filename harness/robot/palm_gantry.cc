#include "harness/robot/palm_gantry.h"

#include "harness/world/angles.h"

namespace parallax::harness {

PalmGantry::PalmGantry(const ArmSpec& spec, PhysicsWorld& world)
    : world_(world), gantry_(*world.layout().find_gantry(spec.joint)) {}

void PalmGantry::reset() {
  line_.reset(world_.gantry_position_m(gantry_));
  wrist_unwrapped_rad_ = world_.gantry_yaw_rad(gantry_);
  wrist_.reset(wrist_unwrapped_rad_);
}

void PalmGantry::lead_to(const Eigen::Vector3d& tool_W, const Eigen::Vector3d& target_W,
                         const Motion& motion) {
  const JointSpec& joint = world_.layout().gantries[gantry_];
  const BodyId parent = *world_.layout().find_body(joint.parent);
  const Eigen::Vector3d now = world_.gantry_position_m(gantry_);
  line_.move_to(now, now + world_.rotation(parent).transpose() * (target_W - tool_W), motion);
}

void PalmGantry::turn_to(double yaw_rad, const Motion& motion) {
  wrist_.move_to(wrist_unwrapped_rad_ + wrapped(yaw_rad - wrist_unwrapped_rad_), motion);
}

void PalmGantry::brake() {
  line_.brake();
  wrist_.brake();
}

void PalmGantry::drive_motors() {
  const double step_s = world_.timestep_s();
  wrist_unwrapped_rad_ += wrapped(world_.gantry_yaw_rad(gantry_) - wrist_unwrapped_rad_);
  const Eigen::Vector3d velocity = line_.next_velocity(world_.gantry_position_m(gantry_), step_s);
  world_.set_gantry(gantry_, velocity, wrist_.next_velocity(wrist_unwrapped_rad_, 0.0, step_s));
}

}  // namespace parallax::harness
