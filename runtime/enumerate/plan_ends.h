#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "runtime/session/solver_session.h"
#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// How a plan ends behind a trace. Executions with the same events, states and returned objects are
/// one trace, and may still end differently: a predicate that nothing else shows may decide.
class PlanEnds {
 public:
  /// `model`, which has a plan, outlives the object. `all_hits`: as in PlanEnumeratorOptions.
  PlanEnds(const CompiledModel& model, std::unique_ptr<SatSolver> solver, bool all_hits);
  /// `done`, `FAILED(class)`, or `cut` at the horizon or where unrolling was cut; several joined by
  /// ` or `. Empty where the plan goes on behind the last timepoint, which meets the constraints,
  /// and if the solver was stopped. One solver call for each end that the plan has.
  std::string of(const Trace& trace);
  /// How many initial states lead to the trace, its fluents given: by the values of predicates
  /// whose symbol is `asked`, and of the variables that the plan begins with. Stops at `most`; 0 if
  /// the solver was stopped. One solver call for each, and one more.
  std::int64_t initial_states(const Trace& trace, const std::set<std::string>& asked,
                              std::int64_t most);

 private:
  std::vector<Literal> assumptions_of(const Trace& trace) const;

  const CompiledModel* model_;
  SolverSession session_;
  compiler::AtomIndex index_;
  bool all_hits_;
  std::vector<std::string> ends_;  // names of PlanEnds, sorted
};

}  // namespace parallax::runtime
