#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "harness/engine/contact_rules.h"
#include "harness/engine/engine_common.h"
#include "harness/engine/link_tree.h"
#include "harness/engine/physics_world.h"

namespace parallax::harness {

/// The part of an engine's state that is no engine's own.
struct EngineState {
  WorldLayout layout;
  SolverSpec solver;
  ContactRules rules;
  std::vector<PoseInLink> in_link;  // by BodyId
  std::vector<double> masses_kg;    // by LinkId
  std::vector<Touch> touches;       // by BodyId
  StateDigest digest;
  bool measure_times = false;
  StepStatistics statistics;

  EngineState(const WorldSpec& spec, WorldLayout its_layout);
  virtual ~EngineState() = default;
  EngineState(const EngineState&) = delete;
  EngineState& operator=(const EngineState&) = delete;
};

/// The shapes that a probe or a ray looks for.
class Sought {
 public:
  /// `ignored` outlives the object.
  static Sought all_but(const BodyMask& ignored) { return Sought(&ignored, std::nullopt); }
  static Sought only(BodyId id) { return Sought(nullptr, id); }

  bool includes(const ContactSide& side) const {
    if (only_) return side.body == only_;
    return !side.body || !(*ignored_)[side.body->index()];
  }

 private:
  Sought(const BodyMask* ignored, std::optional<BodyId> only) : ignored_(ignored), only_(only) {}
  const BodyMask* ignored_;  // null: only one counts
  std::optional<BodyId> only_;
};

/// A hit of a probe or a ray, with the depth of the probe or the distance along the ray [m].
struct Met {
  const ContactSide* side = nullptr;
  double metres = 0.0;
};

/// State and functions that the worlds of all engines share.
class EngineWorld : public PhysicsWorld {
 public:
  const WorldLayout& layout() const final { return state_->layout; }
  double timestep_s() const final { return state_->solver.timestep_s; }
  std::optional<Overlap> reset(std::span<const Placement> placements, std::uint64_t seed) final;
  std::optional<Overlap> find_obstacle(const Probe& probe, const BodyMask& ignored,
                                       double tolerance_m) const final;
  bool overlaps(const Probe& probe, BodyId id) const final;
  std::optional<RayHit> cast_ray(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                                 const BodyMask& ignored) const final;
  std::optional<double> ray_meets(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                                  BodyId id) const final;
  double mass_kg(BodyId id) const final;
  Eigen::Vector3d position(BodyId id) const final;
  Eigen::Matrix3d rotation(BodyId id) const final;
  const Touch& touch(BodyId id) const final { return state_->touches[id.index()]; }
  std::uint64_t digest() const final { return state_->digest.value(); }
  const StepStatistics& statistics() const final { return state_->statistics; }
  void measure_times(bool on) final { state_->measure_times = on; }

 protected:
  explicit EngineWorld(std::unique_ptr<EngineState> state) : state_(std::move(state)) {}

  /// Puts the links at rest, with the masses of the placements.
  virtual void place(std::span<const Placement> placements, std::uint64_t seed) = 0;
  /// Folds the state of all that moves into the digest; false if it is not sane.
  virtual bool fold_state() = 0;
  virtual std::optional<Overlap> deepest_overlap() = 0;
  virtual std::optional<Met> deepest_met(const Probe& probe, const Sought& sought) const = 0;
  virtual std::optional<Met> first_met(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                                       const Sought& sought) const = 0;
  /// The place of the frame that EngineState::in_link refers to, in the world.
  virtual Eigen::Vector3d link_position(LinkId id) const = 0;
  virtual Eigen::Matrix3d link_rotation(LinkId id) const = 0;

  EngineState& state() const { return *state_; }

 private:
  std::unique_ptr<EngineState> state_;
};

}  // namespace parallax::harness
