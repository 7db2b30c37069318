#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

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

/// One window in a solver of its own, which is asked for every way on from a state. What is blocked
/// during an enumeration is released after it.
class StepSolver {
 public:
  /// `model` outlives the solver. `window` is one of its windows; `is_start`: the first.
  StepSolver(const LayeredModel& model, const WindowClauses& window, bool is_start,
             const std::atomic<bool>* stop);
  /// All moves from the state, each once, in no order. None: the solver was stopped, or there are
  /// more than `limit`. For the start both vectors are empty and so are the events of the moves.
  std::optional<std::vector<Move>> moves(const Bits& observed, const Bits& hidden,
                                         std::size_t limit);
  std::int64_t solve_calls() const { return solver_->solve_calls(); }

 private:
  Move read() const;
  void require_window() const;

  const LayeredModel& model_;
  const WindowClauses& window_;
  bool is_start_;
  std::unique_ptr<SatSolver> solver_;
  std::vector<Literal> projection_;  // events, observed, hidden
  std::int32_t next_guard_;
};

}  // namespace parallax::runtime
