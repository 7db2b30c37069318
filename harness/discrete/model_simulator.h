#pragma once

#include <atomic>
#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "harness/discrete/stepped_model.h"
#include "harness/simulator/simulator.h"
#include "runtime/graph/window_solver.h"
#include "runtime/session/solver_session.h"

namespace parallax::harness {

/// A state of a discrete world: its fluents and what is released. `hidden` has every valuation of
/// what else one window hands on to the next that belongs to it, as in GraphNode.
struct WorldState {
  runtime::Bits observed, released;
  std::vector<runtime::Bits> hidden;  // as LayeredModel::hidden, ascending
  friend auto operator<=>(const WorldState&, const WorldState&) = default;
};

struct ModelWorldLimits {
  std::size_t states = 4096;        // that one start or one step leaves open
  std::size_t event_sets = 256;     // by which one event can come about
  std::size_t remembered = 50'000;  // states in answers that are kept
};

/// A discrete world as a simulator. Its parameters are the ground fluents of the model, true or
/// false, all settable; its actions are the ground events; a timepoint takes a second.
///
/// Reset: one of the initial states of the model in which the named fluents are as they were named,
/// each equally likely; kInvalidStart if there is none. Act: the event happens, and of other events
/// no more than the model demands; the world moves to one of the states that the model admits then,
/// each equally likely. If it admits none the action fails, and time alone passes: the world moves
/// on without the event, or stays where even that is impossible.
///
/// Within the horizon that the model was read with, a state counts only if some execution goes on
/// from it to there: the world comes to no state that the model has in no trace.
///
/// Drawn from the seed alone, so that two simulators of one model agree to the last bit.
class ModelSimulator final : public Simulator {
 public:
  /// `stop` may be null, and outlives the simulator: once raised, it answers kLost.
  explicit ModelSimulator(std::shared_ptr<const SteppedModel> world,
                          const std::atomic<bool>* stop = nullptr, ModelWorldLimits limits = {});

  SimulatorInfo info() override { return info_of(*world_); }
  static SimulatorInfo info_of(const SteppedModel& world);
  Outcome reset(const State& initial, std::uint64_t seed) override;
  Outcome act(std::string_view action, const State& arguments, double sim_time_limit_s) override;
  State observe() override;

 private:
  /// States that a question leaves open, or why there is no list.
  struct Answer {
    runtime::WindowEnd end = runtime::WindowEnd::kComplete;
    std::vector<WorldState> states;
    std::size_t limit = 0;  // the one that was hit
  };
  using Question = std::tuple<std::size_t, std::int64_t, WorldState>;  // step, event, before

  const Answer& steps(std::int64_t event);
  Answer find_steps(std::size_t step, std::int64_t event);
  /// The state before a window, in one of its valuations, as assumptions.
  std::vector<runtime::Literal> before(const runtime::Bits& hidden) const;
  /// The states at `t` with these valuations, ascending, that go on.
  Answer grouped(const std::vector<runtime::Bits>& valuations, compiler::Timepoint t);
  std::string no_start(std::vector<runtime::Literal> given, std::vector<std::string> said);
  runtime::SolveStatus goes_on(const runtime::Bits& state, compiler::Timepoint t);
  void move_to(const std::vector<WorldState>& states);
  Outcome no_list(const Answer& answer, const std::string& what) const;

  std::shared_ptr<const SteppedModel> world_;
  ModelWorldLimits limits_;
  std::map<std::string, std::uint32_t, std::less<>> fluents_;  // numbers in the model
  std::map<std::string, std::uint32_t, std::less<>> events_;
  std::vector<bool> is_release_;                    // by place in LayeredModel::hidden
  std::vector<std::int64_t> event_places_;          // by number: among LayeredModel::events, or -1
  std::vector<runtime::Literal> before_;            // LayeredModel::state_before
  std::vector<runtime::Literal> event_literals_;    // by place among LayeredModel::events
  runtime::WindowSolver start_;                     // for the states
  std::vector<runtime::WindowSolver> next_states_;  // as LayeredModel::steps
  std::vector<runtime::WindowSolver> next_events_;  // likewise
  runtime::SolverSession whole_;
  std::map<Question, Answer> known_;
  std::size_t known_states_ = 0;
  WorldState state_;
  std::int64_t timepoint_ = -1;  // -1: not reset
  std::uint64_t seed_ = 0, draws_ = 0, digest_ = 0;
};

}  // namespace parallax::harness
