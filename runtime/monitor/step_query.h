#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <vector>

#include "runtime/graph/window_solver.h"

namespace parallax::runtime {

/// Question about a step. Literals are those of a window.
struct StepQuestion {
  std::vector<Literal> given;  // the state before, and events
  std::vector<Literal> after;  // known about the state after it: no reason for any event
  /// Demanded events that are not given happen where they must, and only then.
  bool is_least = false;
};

/// Literals of a window by their role.
struct StepLiterals {
  std::vector<Literal> after;       // the state that a step leads to
  std::vector<Literal> unobserved;  // events that may happen without being reported
  std::vector<Literal> alone;       // those that may happen while the plan's control stands still
  std::vector<Literal> demanded;    // events that may happen where axioms demand them
  std::vector<Literal> succeeded;   // the plan's perform succeeded
};

/// The states that one step leads to.
class StepQuery {
 public:
  /// `stop` may be null.
  StepQuery(WindowClauses window, const StepLiterals& literals, const std::atomic<bool>* stop);

  // Assumptions: one literal of the list is true.
  Literal some_unobserved() const { return Literal::positive(window_.variables - 2); }
  Literal some_alone() const { return Literal::positive(window_.variables - 1); }
  Literal some_succeeded() const { return Literal::positive(window_.variables); }

  /// At most `limit` states, each by its literals of `after`; a state may occur twice. Only
  /// subset-minimal sets of demanded events happen: no proper subset would do in the same state and
  /// with the same other events, whatever state that leads to.
  WindowSolver::Answer ask(const StepQuestion& question, std::size_t limit);

 private:
  WindowEnd add_least(std::vector<Literal> given, const StepQuestion& question, std::size_t limit,
                      std::vector<Bits>& found);

  WindowClauses window_;
  const StepLiterals& literals_;  // the belief's, which outlives the object
  const std::atomic<bool>* stop_;
  WindowSolver after_;
  std::optional<WindowSolver> unobserved_, demanded_;  // once asked
};

}  // namespace parallax::runtime
