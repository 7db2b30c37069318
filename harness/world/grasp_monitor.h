#pragma once

#include <cstdint>
#include <vector>

#include "harness/world/ode_world.h"

namespace parallax::harness {

/// Decides which free bodies are held. Held: for the last 0.2 s both pads touched the body and its
/// lowest point was more than 10 mm above everything below it that is not the robot.
class GraspMonitor {
 public:
  /// Pads are those of `spec.robot`; a world without a robot holds nothing.
  GraspMonitor(const WorldSpec& spec, const OdeWorld& world);

  void reset();
  /// After each timestep.
  void update();

  bool held(BodyId id) const { return steps_[id.index()] >= steps_needed_; }
  /// Height of the lowest point above the highest support below it [m].
  double clearance_m(BodyId id) const;

 private:
  const OdeWorld& world_;
  std::uint32_t robot_assembly_ = 0;
  std::int64_t steps_needed_ = 1;
  std::vector<BodyId> free_bodies_;
  std::vector<std::int64_t> steps_;  // by body: how long the grasp has lasted
};

}  // namespace parallax::harness
