#pragma once

#include <memory>
#include <optional>

#include "harness/engine/physics_world.h"
#include "harness/robot/grip_watch.h"
#include "harness/robot/perception.h"
#include "harness/simulator/simulator.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

/// A WorldSpec run by the Open Dynamics Engine with the controllers that arguments.h lists.
/// Observes what world_layout.h calls `observables`; takes at reset those that are settable.
/// Bitwise deterministic on one machine: every run after a reset with the same state and seed
/// gives the same digest, in this simulator or in another one of the same spec.
///
/// The engine's random state is one per process: run one simulator at a time if the stepping
/// method ever reads it (the present one does not).
class OdeSimulator final : public Simulator {
 public:
  /// `spec` must pass check_world.
  explicit OdeSimulator(const WorldSpec& spec);
  ~OdeSimulator() override;
  OdeSimulator(const OdeSimulator&) = delete;
  OdeSimulator& operator=(const OdeSimulator&) = delete;

  SimulatorInfo info() override;
  Outcome reset(const State& initial, std::uint64_t seed) override;
  /// An unknown controller, or arguments that it does not take: kUnsupported, nothing moves.
  Outcome act(std::string_view action, const State& arguments, double sim_time_limit_s) override;
  State observe() override { return state(); }
  void record_motion(double interval_s) override;
  State state() const;

  /// Called after each timestep of `act`, with the time since it began; for watching a motion.
  using Watcher = void (*)(void* context, double time_s, const OdeSimulator& simulator);
  void watch(Watcher watcher, void* context);

  const PhysicsWorld& world() const;
  /// The gaze of a mobile robot's camera that has looked at something.
  std::optional<Gaze> gaze() const;
  const StepStatistics& statistics() const;
  /// The watch on bodies that left the grippers, although they squeezed, and on those that they
  /// hold.
  const GripWatch& grips() const;
  void measure_times(bool on);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace parallax::harness
