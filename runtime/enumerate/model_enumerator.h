#pragma once

#include <optional>
#include <vector>

#include "runtime/session/solver_session.h"
#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// All traces of a model at its full horizon: distinct over HoldsAt and Happens, in canonical order
/// (timepoint, then declaration order, false before true). Each trace is blocked for good by one
/// clause over the observable atoms, so cost grows with the number of traces already found.
class ModelEnumerator {
 public:
  /// `session` outlives the enumerator.
  explicit ModelEnumerator(SolverSession& session);
  /// The next trace, or none. `exhausted()` tells whether none means that there is none.
  std::optional<Trace> next();
  bool exhausted() const { return exhausted_; }

 private:
  SolverSession* session_;
  std::vector<Literal> order_;  // observable atoms, false preferred
  std::int64_t found_ = 0;
  bool exhausted_ = false;
};

}  // namespace parallax::runtime
