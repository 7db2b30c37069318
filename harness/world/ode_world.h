#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/world/world_layout.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

/// Position of a body's origin [m] and its turn about z [rad], in the world.
struct Placement {
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
};

/// What touched a free body in the last step.
struct Touch {
  bool near_pad = false, far_pad = false;
  bool support = false;  // anything that is not the robot
};

struct Overlap {
  std::string first, second;  // body names, or "floor"; sorted
  double depth_m = 0.0;
};

/// Axis-aligned box around a body [m].
struct Bounds {
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
};

/// Work done since construction. The times are taken only when asked for.
struct StepStatistics {
  std::int64_t steps = 0;
  std::int64_t contacts = 0;
  std::int64_t engine_messages = 0;  // complaints of the contact solver
  double collide_s = 0.0, solve_s = 0.0;
};

/// One engine world: bodies, joints, stepping, reset. Knows nothing of actions or variables.
/// ODE user guide, chapters 4 to 7 and 10. Bitwise repeatable: the same calls after a reset give
/// the same bits, in this world or in a fresh one of the same spec.
class OdeWorld {
 public:
  struct Engine;  // ode_engine.h

  /// `spec` must pass check_world.
  explicit OdeWorld(const WorldSpec& spec);
  ~OdeWorld();
  OdeWorld(const OdeWorld&) = delete;
  OdeWorld& operator=(const OdeWorld&) = delete;

  const WorldLayout& layout() const;
  double timestep_s() const;

  /// Puts every body (by BodyId; welded ones follow the first of their link) at rest at its
  /// placement, every motor at rest with the force of its joint, and restarts the digest.
  /// Returns the deepest overlap if it exceeds SolverSpec::start_penetration_m.
  std::optional<Overlap> reset(std::span<const Placement> placements, std::uint64_t seed);

  /// One timestep. False when the state is no longer finite or sane: lost until the next reset.
  [[nodiscard]] bool step();

  double slider_position_m(SliderId id) const;
  double slider_rate_m_s(SliderId id) const;
  /// A velocity motor that gives at most `max_force_n`. Wakes the bodies that it moves.
  void set_motor(SliderId id, double velocity_m_s, double max_force_n);

  Eigen::Vector3d position(BodyId id) const;  // of the body's origin in the world [m]
  Eigen::Matrix3d rotation(BodyId id) const;  // R_WB (3 x 3)
  Bounds bounds(BodyId id) const;
  Bounds bounds(BodyId id, const BoxShape& shape) const;  // of one shape of the body
  const Touch& touch(BodyId id) const;

  /// Hash over positions, quaternions and velocities of all moving bodies after each step since
  /// the last reset.
  std::uint64_t digest() const;

  const StepStatistics& statistics() const;
  void measure_times(bool on);

 private:
  std::unique_ptr<Engine> engine_;
};

}  // namespace parallax::harness
