#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/explain/clause_text.h"
#include "runtime/explain/contradiction.h"
#include "runtime/explain/group_solver.h"
#include "runtime/explain/why.h"
#include "tools/app/context.h"
#include "tools/app/trace_fact.h"

namespace parallax::tools {

struct SetOptions {
  bool all = false;        // all minimal sets, not only a smallest one
  std::int64_t limit = 0;  // of --all; 0: no limit
};

/// The observations of a simulation, to be checked against the axioms.
struct ObservedRun {
  runtime::Observed observed;
  std::vector<std::string> lines;  // how it is told: "RobotAt(bTable) does not hold at 6"
  std::size_t shown_from = 0;      // earlier lines are shown on request only
};

/// An axiom of a contradiction, with those of its ground instances that take part.
struct BlamedAxiom {
  std::uint32_t origin = 0;            // index into CompiledModel::origins
  std::vector<std::string> instances;  // as formulas, by timepoint
};

/// A minimal set of axioms, examined closely.
struct Contradiction {
  std::vector<BlamedAxiom> axioms;
  bool instances_minimal = false;  // none of the instances can go
  runtime::ProofVerdict proof = runtime::ProofVerdict::kNotFinished;  // that they contradict
  std::vector<std::size_t> clauses;  // the instances, as GroundContradiction has them
  /// Why nothing is proved of the plan (PlanReservations::verdict); empty: it may be.
  std::string no_proof = {};
};

/// Explains why a model has no trace, or none like an observed run. First the minimal sets of its
/// axioms are found; each may then be examined closely, which takes longer.
class ContradictionSearch {
 public:
  /// Model and context outlive the search.
  ContradictionSearch(const compiler::CompiledModel& model, const std::optional<ObservedRun>& run,
                      Context& context);

  /// Sets of groups of axioms; none if there is no contradiction. Reports kExplanationCutShort if
  /// the search was stopped before that was known.
  base::Result<runtime::MinimalSets> sets(const SetOptions& options);
  /// A minimal set within one that is contradictory; the lower bound is the size of a smallest one.
  /// Reports as `sets` does.
  base::Result<runtime::MinimalSets> within(const runtime::IndexSet& contradiction);
  /// Which instances of the set's axioms it takes, and a proof. Reports kProofRejected if the
  /// checker does not follow the solver.
  Contradiction look_at(const runtime::IndexSet& set);

 private:
  std::vector<std::string> instances_of(std::uint32_t group,
                                        const std::vector<std::size_t>& clauses) const;

  Context& context_;
  runtime::ExecutionFormula formula_;
  runtime::AxiomGroups axioms_;
  runtime::ClauseText texts_;
  runtime::Effort effort_;  // for the instances of all sets together
};

struct WhyQuery {
  std::string fact;        // `HoldsAt(F,3)`, `!HoldsAt(F(a),3)`, `Happens(E(),2)`
  std::int64_t trace = 1;  // its number in the list of traces
  bool all = false;        // tell further causes as well
};

/// The chain of facts behind one fact of a trace.
struct FactExplanation {
  TraceFact fact;
  std::int64_t trace = 0;
  /// The fact as it is in the trace. None: no clause mentions the atom, so that it is false in
  /// every trace, and there are no steps.
  std::optional<compiler::Literal> asked;
  std::vector<runtime::WhyStep> steps;  // earliest first
};

/// Reports kNoSuchFact and kNoSuchTrace; also, with a result, kExplanationCutShort if the search
/// was stopped before it was known whether every choice is one.
base::Result<FactExplanation> explain_why(const compiler::CompiledModel& model,
                                          const WhyQuery& query, Context& context);

}  // namespace parallax::tools
