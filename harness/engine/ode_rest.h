#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "harness/engine/ode_hosts.h"

namespace parallax::harness {

/// A command for the motors of a joint: velocities along the axes of a gantry's parent and about z
/// [m/s, rad/s], or one rate; the greatest force of a slider or hinge [N or Nm].
struct MotorCommand {
  Eigen::Vector4d rates = Eigen::Vector4d::Zero();
  double max_force = 0.0;
};

/// Joints of a robot on gantries cost nothing while they are at rest: what they connect moves as
/// one body, or stands still with the world, until their motors are told something else, something
/// touches the hand that they move, or they would need half the force that they have. Below that
/// motors hold a joint as firmly. A hand on a gantry that touches something is never at rest, nor a
/// finger: what it holds may slip. Hinges of an arm that is a chain may rest meanwhile, until
/// something strikes the arm; and those that move without needing half their torque are solved
/// without a bound on it, which is less work for the engine and the same motion.
class RestingJoints {
 public:
  explicit RestingJoints(OdeWorld::Engine& engine);

  bool manages(const SliderId id) const { return by_slider_[id.index()] >= 0; }
  bool manages(const HingeId id) const { return by_hinge_[id.index()] >= 0; }
  void tell(SliderId id, const MotorCommand& command);
  void tell(HingeId id, const MotorCommand& command);
  bool tell(GantryId id, const MotorCommand& command);

  dxBody* host(std::uint32_t link) const { return hosts_.of(link); }
  Hosts& hosts() { return hosts_; }
  void reset();
  /// Call it before a step; `touched` is by link, from the contacts of the step.
  void begin_step(const std::vector<bool>& touched);
  /// Call it after a step.
  void end_step();
  std::int64_t resting() const { return resting_; }

 private:
  struct Watch {
    MotorCommand now, before;
    std::int64_t calm_steps = 0;
    bool overloaded = false;
    bool solved = false;  // in the last step
  };
  void find_struck();
  void bound_motors(const std::vector<bool>& disturbed);
  bool is_calm(const RobotJoint& joint, const Watch& watch) const;
  bool has_torque_left(std::size_t joint) const;
  bool is_overloaded(const RobotJoint& joint, const Watch& watch) const;
  std::vector<bool> struck_joints() const;
  std::vector<bool> disturbed(const std::vector<bool>& touched) const;

  OdeWorld::Engine& engine_;
  Hosts hosts_;
  bool has_chain_ = false;
  std::vector<bool> struck_;                           // by link, in this step
  std::vector<Watch> watches_;                         // by joint of the hosts
  std::vector<int> by_slider_, by_hinge_, by_gantry_;  // index of a joint; -1: not of the robot
  std::int64_t calm_steps_needed_ = 1;
  std::int64_t resting_ = 0;
};

}  // namespace parallax::harness
