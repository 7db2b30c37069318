#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/session/solver_session.h"
#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// What is known of the least values of a model's objectives, the first objective first.
struct Optimum {
  /// Of the best trace found; empty: none was found.
  std::vector<std::int64_t> values;
  std::optional<Trace> witness;
  /// So many objectives are decided: the best traces have these values. All of them: the optimum.
  std::size_t decided = 0;
  /// Of the first objective that is not decided: no trace that has the values of those before has
  /// less.
  std::optional<std::int64_t> at_least;
  /// There is no trace: the solver said so.
  bool none = false;
  std::int64_t cores = 0, solve_calls = 0;

  bool proved() const { return none || (witness && decided == values.size()); }
};

/// Finds a trace with the lexicographically least values of `session.model().objectives`: at the
/// full horizon, or, where state constraints end traces, of any length up to it, ending at the
/// first hit; of equals a shortest one. Lengths are looked at in turn, each only as far as it can
/// be better than those before. The session is fresh, and of no use afterwards.
Optimum find_optimum(SolverSession& session);

}  // namespace parallax::runtime
