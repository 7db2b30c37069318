#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/session/solver_session.h"
#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// Leaves to the session only executions in which every event that axioms can demand has a reason:
/// the plan performs it, or an axiom would be false without it. That is necessary in a closed world
/// and keeps the rest from being enumerated; ClosedWorld tells what is left. Does nothing to a
/// model without a plan, in which anything may be performed. Linear in the clauses.
void require_reasons(SolverSession& session);

/// Tells traces in which events happen by themselves although nothing demands them. A model with
/// triggers (`... -> Happens(Slam(),time)`) admits them; in the closed world only subset-minimal
/// sets of demanded events happen beside what is performed, as in a world that is a model.
class ClosedWorld {
 public:
  ClosedWorld(const CompiledModel& model, std::unique_ptr<SatSolver> solver);

  /// Yes if at each timepoint no event could be left out, given the states and events up to there.
  /// `performed`: the event at each timepoint that happens in any case. One solver call for each
  /// other event; undecided if the solver was stopped.
  base::Known admits(const Trace& trace, const std::vector<std::string>& performed);

 private:
  const CompiledModel* model_;
  SolverSession session_;
  std::vector<bool> is_demandable_;  // by event
};

}  // namespace parallax::runtime
