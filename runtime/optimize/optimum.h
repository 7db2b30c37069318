#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/session/solver_session.h"
#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// Results on the least values of a model's objectives, the first objective first.
struct Optimum {
  /// Values of the best trace found; empty: none was found.
  std::vector<std::int64_t> values;
  std::optional<Trace> witness;
  /// Number of objectives that are decided: the best traces have these values. All of them: the
  /// optimum.
  std::size_t decided = 0;
  /// Lower bound of the first undecided objective, among traces that have the values of those
  /// before.
  std::optional<std::int64_t> at_least;
  /// The solver proved that there is no trace.
  bool none = false;
  std::int64_t cores = 0, solve_calls = 0;

  bool proved() const { return none || (witness && decided == values.size()); }
};

/// Finds a trace with the lexicographically least values of `session.model().objectives`: at the
/// full horizon, or, where state constraints end traces, of any length up to it, ending at the
/// first hit. Among equal traces it takes a shortest one. Lengths are searched in turn, each only
/// as far as it can be better than those before. The session is fresh, and cannot be used
/// afterwards.
Optimum find_optimum(SolverSession& session);

}  // namespace parallax::runtime
