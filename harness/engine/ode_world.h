#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "harness/world/world_layout.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

/// Brings the engine up once per process and gives the calling thread its data. Cheap when done
/// already; call it at the start of everything that touches the engine.
void enter_ode();

/// "0.16.2"
std::string ode_version();

/// What touched a free body in the last step.
struct Touch {
  std::uint32_t near_pads = 0, far_pads = 0;  // bit g: a pad of gripper g
  bool support = false;                       // anything that is not the robot
  bool near_pad(std::uint32_t gripper = 0) const { return (near_pads >> gripper & 1U) != 0; }
  bool far_pad(std::uint32_t gripper = 0) const { return (far_pads >> gripper & 1U) != 0; }
};

/// A box that need not be part of the world.
struct Probe {
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_WS = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_WS = Eigen::Matrix3d::Identity();
};

struct RayHit {
  std::string body;  // or "floor"
  double distance_m = 0.0;
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

  /// Where the child of a gantry is, from its default place, in the frame of the parent [m].
  Eigen::Vector3d gantry_position_m(GantryId id) const;
  /// The child's turn about z against the parent, 0 at the default; within half a turn.
  double gantry_yaw_rad(GantryId id) const;
  /// Velocities in the parent's frame; the forces are those of the joint.
  void set_gantry(GantryId id, const Eigen::Vector3d& velocity_m_s, double yaw_rate_rad_s);

  /// The first body, or "floor", that the box overlaps by more than `tolerance_m`; the deepest of
  /// its contacts counts. Bodies in `ignored` do not.
  std::optional<Overlap> find_obstacle(const Probe& probe, const BodyMask& ignored,
                                       double tolerance_m) const;
  /// Does the box meet a shape of this body?
  bool overlaps(const Probe& probe, BodyId id) const;
  /// The nearest thing on the way from `from_W` to `to_W` that is not in `ignored`; the floor is
  /// met from both sides.
  std::optional<RayHit> cast_ray(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                                 const BodyMask& ignored) const;
  /// Where the body is first met on that way, whatever else there is [m].
  std::optional<double> ray_meets(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                                  BodyId id) const;

  double mass_kg(BodyId id) const;
  Eigen::Vector3d position(BodyId id) const;  // of the body's origin in the world [m]
  Eigen::Matrix3d rotation(BodyId id) const;  // R_WB (3 x 3)
  /// One box of the body, where it is now.
  Probe placed(BodyId id, const BoxShape& shape) const;
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
