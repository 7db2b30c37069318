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

/// The touches of a free body in the last step.
struct Touch {
  std::uint32_t near_pads = 0, far_pads = 0;  // bit g: a pad of gripper g
  bool support = false;                       // anything that is not the robot
  bool near_pad(std::uint32_t gripper = 0) const { return (near_pads >> gripper & 1U) != 0; }
  bool far_pad(std::uint32_t gripper = 0) const { return (far_pads >> gripper & 1U) != 0; }
};

/// A shape that need not be part of the world.
struct Probe {
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_WS = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_WS = Eigen::Matrix3d::Identity();
  ShapeForm form = ShapeForm::kBox;
  std::shared_ptr<const ConvexHull> hull = {};  // of kHull
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
struct BodyBounds {
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
};

/// Work done since construction. The times are taken only when asked for.
struct StepStatistics {
  std::int64_t steps = 0;
  std::int64_t contacts = 0;
  std::int64_t joints_at_rest = 0;  // in all steps together: not solved, because nothing moved them
  std::int64_t engine_messages = 0;  // complaints of the contact solver in steps left unsolved
  std::int64_t solved_again = 0;     // steps that it gave up at first
  double collide_s = 0.0, solve_s = 0.0;
};

/// The engine that steps a world, as reports name it.
struct EngineName {
  std::string name, version;  // "ode", "0.16.2"
};

/// A world of rigid bodies that an engine steps: bodies, joints, stepping, reset. Knows nothing of
/// actions or variables. Robots, perception, recording and checks use nothing else of an engine.
/// Bitwise repeatable: the same calls after a reset give the same bits, in this world or in a
/// fresh one of the same spec.
class PhysicsWorld {
 public:
  PhysicsWorld() = default;
  virtual ~PhysicsWorld() = default;
  PhysicsWorld(const PhysicsWorld&) = delete;
  PhysicsWorld& operator=(const PhysicsWorld&) = delete;

  virtual EngineName engine() const = 0;
  /// Gives the calling thread what the engine needs to work on it. Cheap when done already.
  virtual void enter_thread() const = 0;

  virtual const WorldLayout& layout() const = 0;
  virtual double timestep_s() const = 0;

  /// Puts every body (by BodyId; welded ones follow the first of their link) at rest at its
  /// placement, every motor at rest with the force of its joint, and restarts the digest.
  /// Returns the deepest overlap if it exceeds SolverSpec::start_penetration_m.
  virtual std::optional<Overlap> reset(std::span<const Placement> placements,
                                       std::uint64_t seed) = 0;

  /// One timestep. False when the state is no longer finite or sane: lost until the next reset.
  [[nodiscard]] virtual bool step() = 0;

  virtual double slider_position_m(SliderId id) const = 0;
  virtual double slider_rate_m_s(SliderId id) const = 0;
  /// A velocity motor that gives at most `max_force_n`. Wakes the bodies that it moves.
  virtual void set_motor(SliderId id, double velocity_m_s, double max_force_n) = 0;

  /// Within half a turn, 0 by default.
  virtual double hinge_angle_rad(HingeId id) const = 0;
  virtual double hinge_rate_rad_s(HingeId id) const = 0;
  /// A velocity motor that gives at most `max_torque_nm`. Wakes the bodies that it turns.
  virtual void set_hinge_motor(HingeId id, double rate_rad_s, double max_torque_nm) = 0;

  /// The position of the child of a gantry relative to its default place, in the frame of the
  /// parent [m].
  virtual Eigen::Vector3d gantry_position_m(GantryId id) const = 0;
  /// The child's turn about z against the parent, 0 at the default; within half a turn.
  virtual double gantry_yaw_rad(GantryId id) const = 0;
  /// Velocities in the parent's frame; the forces are those of the joint.
  virtual void set_gantry(GantryId id, const Eigen::Vector3d& velocity_m_s,
                          double yaw_rate_rad_s) = 0;

  /// The first body, or "floor", that the probe overlaps by more than `tolerance_m`; the deepest of
  /// its contacts counts. Bodies in `ignored` do not.
  virtual std::optional<Overlap> find_obstacle(const Probe& probe, const BodyMask& ignored,
                                               double tolerance_m) const = 0;
  /// Does the probe meet a shape of this body?
  virtual bool overlaps(const Probe& probe, BodyId id) const = 0;
  /// The nearest thing on the way from `from_W` to `to_W` that is not in `ignored`; the floor is
  /// met from both sides.
  virtual std::optional<RayHit> cast_ray(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                                         const BodyMask& ignored) const = 0;
  /// Where the body is first met on that way, whatever else there is [m].
  virtual std::optional<double> ray_meets(const Eigen::Vector3d& from_W,
                                          const Eigen::Vector3d& to_W, BodyId id) const = 0;

  virtual double mass_kg(BodyId id) const = 0;
  virtual Eigen::Vector3d position(BodyId id) const = 0;  // of the body's origin in the world [m]
  virtual Eigen::Matrix3d rotation(BodyId id) const = 0;  // R_WB (3 x 3)
  virtual const Touch& touch(BodyId id) const = 0;

  /// Hash over positions, quaternions and velocities of all moving bodies after each step since
  /// the last reset.
  virtual std::uint64_t digest() const = 0;

  virtual const StepStatistics& statistics() const = 0;
  virtual void measure_times(bool on) = 0;

  /// One shape of the body, where it is now.
  Probe placed(BodyId id, const BodyShape& shape) const;
  BodyBounds bounds(BodyId id) const;
  BodyBounds bounds(BodyId id, const BodyShape& shape) const;  // of one shape of the body
};

/// The engine's world made from `spec`, which must pass check_world.
std::unique_ptr<PhysicsWorld> make_world(const WorldSpec& spec);

}  // namespace parallax::harness
