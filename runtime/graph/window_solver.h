#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "runtime/enumerate/clause_search.h"
#include "runtime/graph/layered_model.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

/// Truth values, false before true: the order of vectors is the canonical order.
using Bits = std::vector<bool>;

/// Adds each literal, or its negation where its value is false; there may be more literals.
void assume(std::span<const Literal> literals, const Bits& values, std::vector<Literal>& out);

/// One way through a window: the events, and the state after it.
struct Move {
  Bits events;    // by LayeredModel::events
  Bits observed;  // by LayeredModel::observed
  Bits hidden;    // by LayeredModel::hidden
  friend auto operator<=>(const Move&, const Move&) = default;
};

/// The move with these values, which are in the order of its members; there may be no events.
Move move_of(const LayeredModel& model, const Bits& values);

/// Limits of one question to a window.
struct WindowLimits {
  std::size_t valuations = 0;
  std::int64_t conflicts = std::numeric_limits<std::int64_t>::max();  // of all questions together
  bool solver = true;  // may answer where the search gives up
};

/// The reason why an answer ends.
enum class WindowEnd : std::uint8_t {
  kComplete,
  kTooMany,      // there are more valuations than the limit
  kSpent,        // the search has used up its conflicts
  kNeedsSolver,  // the search gives up, and the limits allow no solver
  kStopped,
};

/// The valuations of some variables that the clauses of one window admit under assumptions, each
/// once: by search, and from the first question on that meets too many conflicts by a solver that
/// learns.
class WindowSolver {
 public:
  /// `window` outlives the solver. Valuations are told apart by `projection`. `stop` may be null.
  WindowSolver(const WindowClauses& window, std::vector<Literal> projection,
               const std::atomic<bool>* stop);

  struct Answer {
    std::vector<Bits> found;  // by projection
    WindowEnd end = WindowEnd::kComplete;
    bool is_complete() const { return end == WindowEnd::kComplete; }
  };
  /// The valuations, in canonical order.
  Answer ask(std::span<const Literal> given, const WindowLimits& limits);
  /// The valuations whose true literals are a subset-minimal set, at most `limit`, in the reverse
  /// of the canonical order.
  Answer least(std::span<const Literal> given, std::size_t limit);

  std::int64_t solve_calls() const { return solver_ == nullptr ? 0 : solver_->solve_calls(); }
  /// Literals set by the search; a call of the solver counts as one whole valuation.
  std::int64_t work() const { return search_.assignments() + solve_calls() * window_.variables; }

 private:
  template <typename Value>
  Bits read(const Value& value) const;
  Bits solver_valuation() const;
  Answer search(std::span<const Literal> given, const WindowLimits& limits);
  Answer solve(std::span<const Literal> given, std::size_t limit);
  SolveStatus solve_with(std::span<const Literal> given, std::span<const Literal> more);
  SolveStatus shrink(std::span<const Literal> given, Bits& valuation);
  SatSolver& solver();
  Literal new_guard() { return Literal::positive(next_guard_++); }

  const WindowClauses& window_;
  std::vector<Literal> projection_;
  const std::atomic<bool>* stop_;
  ClauseSearch search_;
  bool search_gave_up_ = false;
  std::unique_ptr<SatSolver> solver_;  // once it is needed
  std::int32_t next_guard_;
};

}  // namespace parallax::runtime
