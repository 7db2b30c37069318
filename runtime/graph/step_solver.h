#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/enumerate/clause_search.h"
#include "runtime/graph/layered_model.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

/// Truth values, false before true: the order of vectors is the canonical order.
using Bits = std::vector<bool>;

/// What one window admits: the events, and the state after it.
struct Move {
  Bits events;    // by LayeredModel::events
  Bits observed;  // by LayeredModel::observed
  Bits hidden;    // by LayeredModel::hidden
  friend auto operator<=>(const Move&, const Move&) = default;
};

struct MoveLimits {
  std::size_t moves = 0;       // from one state
  std::int64_t conflicts = 0;  // of the search, for all states together
};

/// One window, which is asked for every way on from a state: by search, and from the first state on
/// where that meets too many conflicts by a solver that learns. What is blocked in the solver
/// during an enumeration is released after it.
class StepSolver {
 public:
  /// `model` outlives the solver. `window` is one of its windows; `is_start`: the first. `stop` may
  /// be null.
  StepSolver(const LayeredModel& model, const WindowClauses& window, bool is_start,
             const std::atomic<bool>* stop);
  /// All moves from the state, each once, in canonical order. None: it was stopped, or a limit was
  /// hit. For the start both vectors are empty and so are the events of the moves.
  std::optional<std::vector<Move>> moves(const Bits& observed, const Bits& hidden,
                                         const MoveLimits& limits);
  std::int64_t solve_calls() const { return solver_ == nullptr ? 0 : solver_->solve_calls(); }

 private:
  template <typename Value>
  Move read(const Value& value) const;
  template <typename Value>
  void require_window(const Value& value) const;
  bool is_stopped() const { return stop_ != nullptr && stop_->load(); }
  std::optional<std::vector<Move>> solve(const std::vector<Literal>& state, std::size_t limit);
  ClauseSearch::Status search(const std::vector<Literal>& state, const MoveLimits& limits,
                              std::vector<Move>& found);
  bool is_spent(const MoveLimits& limits) const { return search_.conflicts() >= limits.conflicts; }
  void start_solver();

  const LayeredModel& model_;
  const WindowClauses& window_;
  bool is_start_;
  const std::atomic<bool>* stop_;
  std::vector<Literal> projection_;  // events, observed, hidden
  ClauseSearch search_;
  std::unique_ptr<SatSolver> solver_;  // once the search has given up
  std::int32_t next_guard_;
};

}  // namespace parallax::runtime
