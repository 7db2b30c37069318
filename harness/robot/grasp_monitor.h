#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/engine/physics_world.h"

namespace parallax::harness {

/// Decides which free bodies are held. Held: for SolverSpec::held_after_s both pads of a
/// gripper touched the body, and its lowest point was more than SolverSpec::held_clearance_m above
/// everything below it that is not the robot.
class GraspMonitor {
 public:
  /// A world without a robot holds nothing.
  GraspMonitor(const WorldSpec& spec, const PhysicsWorld& world);

  void reset();
  /// Call it after each timestep.
  void update();

  bool held(BodyId id) const;
  bool held_by(std::uint32_t gripper, BodyId id) const {
    return steps_[gripper][id.index()] >= steps_needed_;
  }
  /// The body that a gripper holds; none, or the first in order of names.
  std::optional<BodyId> held_body(std::uint32_t gripper) const;
  /// Height of the lowest point above the highest support below it [m].
  double clearance_m(BodyId id) const;

 private:
  const PhysicsWorld& world_;
  std::uint32_t robot_assembly_ = 0;
  std::int64_t steps_needed_ = 1;
  std::vector<BodyId> free_bodies_;
  std::vector<std::vector<std::int64_t>> steps_;  // by gripper and body: how long it has lasted
  double clearance_needed_m_;
};

}  // namespace parallax::harness
