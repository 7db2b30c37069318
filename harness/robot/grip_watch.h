#pragma once

// Losses that the solver may have made up. By Coulomb's law a load stays between two pads while
// friction times the squeeze, of both, exceeds what its weight and the motions asked for pull with.
// The watch keeps the least of that ratio, the margin, for each grip, and tells when a load leaves
// a grip that still squeezes. What strikes the load is not part of the margin, so a loss with a
// large one is a reason to look again, no proof. Cost: a look at each gripper and body a step.

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "harness/engine/physics_world.h"

namespace parallax::harness {

/// Commands to a gripper in one step.
struct GripDemand {
  double squeeze_n = 0.0;                       // 0: it does not squeeze
  double level_m_s2 = 0.0, upright_m_s2 = 0.0;  // accelerations that motions ask for
};

/// A free body that left a gripper that squeezed.
struct GripLoss {
  std::uint32_t gripper = 0;
  BodyId body;
  double margin = 0.0;  // the least since the pads closed on it
};

/// State of a body in a gripper since the last reset.
enum class GripState : std::uint8_t { kNever, kInGrip, kLetGo, kLost };

/// Watches the pads of all grippers of a world.
class GripWatch {
 public:
  GripWatch(const WorldSpec& spec, const PhysicsWorld& world);

  void reset();
  /// Forgets the losses told so far.
  void begin_act() { losses_.clear(); }
  /// Call it after each timestep, with one demand for each gripper.
  void update(const std::vector<GripDemand>& demands);
  /// Call it at the end of an act, when the world is observed. A body that no longer lies between
  /// both pads then is lost, however short a time ago it left.
  void end_act();

  /// Losses during the act, in the order of time.
  const std::vector<GripLoss>& losses() const { return losses_; }
  GripState state(std::uint32_t gripper, BodyId body) const;

 private:
  struct Grip {
    std::vector<std::int64_t> touched;  // by free body: steps in a row between both pads
    std::optional<BodyId> load;
    double margin = 0.0;
    std::int64_t apart = 0;  // steps in a row without a touch of both pads
  };

  double margin_of(std::uint32_t gripper, BodyId body, const GripDemand& demand) const;
  void grip_anew(std::uint32_t gripper, const GripDemand& demand);
  void lose(std::uint32_t gripper);

  const PhysicsWorld& world_;
  double gravity_m_s2_;
  std::int64_t steps_to_grip_ = 1, steps_to_lose_ = 1;
  std::vector<BodyId> free_bodies_;
  std::vector<std::vector<double>> friction_;  // by gripper and free body: of the worse pad
  std::vector<Grip> grips_;
  std::map<std::pair<std::uint32_t, std::size_t>, GripState> states_;  // by gripper and body
  std::vector<GripLoss> losses_;
};

}  // namespace parallax::harness
