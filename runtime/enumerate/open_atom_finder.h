#pragma once

// Which atoms does a trace leave open?
//
// Two executions are one trace if they agree on HoldsAt and Happens; ReleasedAt and user predicates
// may differ. For one trace, HoldsAt and Happens are given, and the clauses that are left tell
// which other atoms can have both values (open_variables.h). A trace that ends before the horizon
// goes on somehow: there a solver is asked for a valuation in which some other atom is not as in
// the trace. Atoms that differ are open and are not asked about again, until no other valuation is
// left. For all traces at once: two copies of the model that share HoldsAt and Happens cannot
// differ elsewhere if these define the rest (Padoa, 1901). Cost: linear in the model for each
// trace; with state constraints one call for each round in which an atom differs; one call,
// limited, for all traces.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/session/solver_session.h"
#include "runtime/trace/open_atoms.h"

namespace parallax::runtime {

class OpenVariables;

/// Has the model ReleasedAt or user predicates, of which traces may differ without being told
/// apart?
bool has_hidden_atoms(const CompiledModel& model);

class OpenAtomFinder {
 public:
  using MakeSolver = std::function<std::unique_ptr<SatSolver>()>;
  /// Asks no solver yet. `model` outlives the finder. `all_hits`: as in PlanEnumeratorOptions.
  OpenAtomFinder(const CompiledModel& model, MakeSolver make_solver, bool all_hits);
  ~OpenAtomFinder();

  /// Does no trace of the model leave an atom open? May be false where the answer would take too
  /// long, and is for models with state constraints. Asked once; then it costs nothing.
  bool none_is_open();
  /// The atoms that a trace of the model leaves open. None if the solver was stopped.
  std::optional<OpenAtoms> find(const Trace& trace);
  /// All ReleasedAt and user predicates up to the end of the trace: no other atom can be open.
  OpenAtoms all_hidden(const Trace& trace) const;

 private:
  bool is_defined() const;
  std::vector<Literal> assumptions_of(const Trace& trace) const;
  std::vector<Literal> hidden_of(const Trace& trace) const;
  OpenAtoms atoms_of(const Trace& trace, std::vector<std::int32_t> variables) const;
  SolveStatus find_other(Timepoint n, std::vector<Literal>& assumptions,
                         const std::vector<Literal>& same);
  std::optional<std::vector<std::int32_t>> open_of_whole(const Trace& trace);
  std::optional<std::vector<std::int32_t>> open_of_prefix(const Trace& trace);

  const CompiledModel* model_;
  MakeSolver make_solver_;
  bool all_hits_;
  bool has_hidden_;
  std::optional<bool> none_;
  // Made for the first trace: the first one without state constraints, the others with them.
  std::unique_ptr<OpenVariables> variables_;
  std::unique_ptr<SolverSession> session_;
  std::optional<compiler::AtomIndex> index_;
};

}  // namespace parallax::runtime
