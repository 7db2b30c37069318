#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "harness/engine/engine_world.h"

namespace parallax::harness {

struct EngineInput;  // engine_module.h

/// A world that Bullet steps, in double precision: trees of links in joint coordinates
/// (Featherstone), contacts by GJK, EPA and clipped faces, forces by sequential impulses with a
/// friction cone (Catto, GDC 2005).
class BulletWorld final : public EngineWorld {
 public:
  struct Engine;  // bullet_engine.h

  explicit BulletWorld(const EngineInput& input);
  ~BulletWorld() override;
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  EngineName engine() const override;
  void enter_thread() const override {}
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

 private:
  void place(std::span<const Placement> placements, std::uint64_t seed) override;
  bool fold_state() override;
  std::optional<Overlap> deepest_overlap() override;
  std::optional<Met> deepest_met(const Probe& probe, const Sought& sought) const override;
  std::optional<Met> first_met(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                               const Sought& sought) const override;
  Eigen::Vector3d link_position(LinkId id) const override;
  Eigen::Matrix3d link_rotation(LinkId id) const override;

  Engine* engine_;  // the state
};

}  // namespace parallax::harness
