#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "harness/engine/physics_world.h"

namespace parallax::harness {

struct EngineInput;  // mujoco_module.h

/// A world that MuJoCo steps: generalised coordinates, soft contacts of an elliptic cone, Newton's
/// method (Todorov, ICRA 2014; "Computation" in the documentation).
class MujocoWorld final : public PhysicsWorld {
 public:
  struct Engine;  // mujoco_engine.h

  explicit MujocoWorld(const EngineInput& input);
  ~MujocoWorld() override;
  MujocoWorld(const MujocoWorld&) = delete;
  MujocoWorld& operator=(const MujocoWorld&) = delete;

  EngineName engine() const override;
  void enter_thread() const override;
  const WorldLayout& layout() const override;
  double timestep_s() const override;
  std::optional<Overlap> reset(std::span<const Placement> placements, std::uint64_t seed) override;
  bool step() override;
  double slider_position_m(SliderId id) const override;
  double slider_rate_m_s(SliderId id) const override;
  void set_motor(SliderId id, double velocity_m_s, double max_force_n) override;
  double hinge_angle_rad(HingeId id) const override;
  double hinge_rate_rad_s(HingeId id) const override;
  void set_hinge_motor(HingeId id, double rate_rad_s, double max_torque_nm) override;
  Eigen::Vector3d gantry_position_m(GantryId id) const override;
  double gantry_yaw_rad(GantryId id) const override;
  void set_gantry(GantryId id, const Eigen::Vector3d& velocity_m_s, double yaw_rate_rad_s) override;
  std::optional<Overlap> find_obstacle(const Probe& probe, const BodyMask& ignored,
                                       double tolerance_m) const override;
  bool overlaps(const Probe& probe, BodyId id) const override;
  std::optional<RayHit> cast_ray(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                                 const BodyMask& ignored) const override;
  std::optional<double> ray_meets(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                                  BodyId id) const override;
  double mass_kg(BodyId id) const override;
  Eigen::Vector3d position(BodyId id) const override;
  Eigen::Matrix3d rotation(BodyId id) const override;
  const Touch& touch(BodyId id) const override;
  std::uint64_t digest() const override;
  const StepStatistics& statistics() const override;
  void measure_times(bool on) override;

 private:
  std::unique_ptr<Engine> engine_;
};

}  // namespace parallax::harness
