#pragma once

#include <vector>

#include "runtime/enumerate/trace_source.h"
#include "runtime/session/solver_session.h"

namespace parallax::runtime {

/// Blocks each trace for good by one clause over the atoms that tell traces apart, and finds the
/// first one of the rest by a walk over these atoms: the first trace costs little, and each further
/// one grows dearer with the number of those found.
class ModelEnumerator final : public TraceSource {
 public:
  /// `session` outlives the enumerator.
  explicit ModelEnumerator(SolverSession& session, Distinct distinct = Distinct::kObservable);
  std::optional<Trace> next() override;
  bool exhausted() const override { return exhausted_; }
  SourceStats stats() const override;

 private:
  SolverSession* session_;
  std::vector<Literal> order_;  // the atoms, false preferred
  std::int64_t found_ = 0;
  bool exhausted_ = false;
};

}  // namespace parallax::runtime
