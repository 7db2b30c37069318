#pragma once

// A guard against losses that the solver made up. When a load leaves a grip whose margin by
// Coulomb's law exceeded kSureMargin (grip_watch.h), the same start, seed and actions are simulated
// again with half the step, a quarter of it, and by the other engine where it is there and takes
// the world. If one of them keeps the load, the loss is of the solver: the act answers `lost`, so
// that the simulation is neither clean nor a discrepancy, for whoever asked. If all that have an
// answer lose it too, it stands. Everything follows from start, seed and actions, so that the same
// simulation has the same outcome anywhere. Cost: nothing without such a loss, and with one about
// seven times the simulation so far, and the other engine's.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/robot/ode_simulator.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// Margin by Coulomb's law above which a lost load is simulated again.
inline constexpr double kSureMargin = 2.0;

/// The result of repeating a loss with another solver.
enum class SolverAnswer : std::uint8_t { kLosesIt, kKeepsIt, kNone };

/// One repetition: "half the step", "mujoco".
struct SolverRepetition {
  std::string with;
  SolverAnswer answer = SolverAnswer::kNone;
};

/// The sentence about a loss that does not occur in one of the repetitions; empty if the loss
/// stands.
std::string solver_loss_words(const std::string& body, double margin,
                              const std::vector<SolverRepetition>& repetitions);

/// A world that repetitions are made in, and the words for it.
struct RepetitionWorld {
  std::string with;  // "half the step"
  WorldSpec spec;
};
/// The worlds that a loss in `spec` is looked at in, in their order.
std::vector<RepetitionWorld> repetition_worlds(const WorldSpec& spec);

/// An OdeSimulator behind that guard.
class GuardedSimulator final : public Simulator {
 public:
  /// Finds the worlds for a loss of `spec`, when there is one.
  using FindWorlds = std::vector<RepetitionWorld> (*)(const WorldSpec& spec);
  /// `spec` must pass check_world.
  explicit GuardedSimulator(const WorldSpec& spec, FindWorlds find = repetition_worlds);
  ~GuardedSimulator() override;

  SimulatorInfo info() override;
  void record_motion(double interval_s) override { usual_.record_motion(interval_s); }
  Outcome reset(const State& initial, std::uint64_t seed) override;
  Outcome act(std::string_view action, const State& arguments, double sim_time_limit_s) override;
  State observe() override { return usual_.observe(); }

  /// The repetitions of the last loss that was looked at; none since the last reset.
  const std::vector<SolverRepetition>& repetitions() const { return repetitions_; }

 private:
  struct Act {
    std::string action;
    State arguments;
    double sim_time_limit_s = 0.0;
  };
  struct Variant {
    RepetitionWorld world;
    std::unique_ptr<OdeSimulator> simulator;  // made when it is first asked
  };

  SolverAnswer ask(Variant& variant, const GripLoss& loss);

  WorldSpec spec_;
  FindWorlds find_;
  OdeSimulator usual_;
  std::optional<std::vector<Variant>> variants_;  // found when they are first needed
  State initial_;
  std::uint64_t seed_ = 0;
  std::vector<Act> acts_;  // since the last reset
  std::string lost_;       // why nothing goes on until the next reset
  std::vector<SolverRepetition> repetitions_;
};

}  // namespace parallax::harness
