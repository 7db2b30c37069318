#pragma once

#include <cstddef>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/explain/group_solver.h"
#include "runtime/proof/drat_checker.h"

namespace parallax::runtime {

/// Minimal sets of groups: the groups of a set contradict each other, and without any one of them
/// the rest do not.
struct MinimalSets {
  std::vector<IndexSet> sets;  // by size, then by their elements; empty: there is no contradiction
  /// From smallest_set: no contradiction has fewer groups. From all_minimal_sets: there are no
  /// others.
  bool proven = false;
  /// Lower bound on the number of groups in a contradiction.
  std::size_t lower_bound = 0;
  /// The solver was stopped before there was a set, or a proof that there is none.
  bool unknown = false;
};

/// Makes a contradictory set minimal by leaving out one member after the other, and members that
/// the solver did not use. False if the solver was stopped, or the effort (null: any) did not
/// suffice; the set is then contradictory, and as small as it came.
bool shrink(GroupSolver& solver, IndexSet& contradiction, Effort* effort = nullptr);

/// A contradiction with as few groups as possible, by the duality of minimal contradictions and
/// minimal corrections (Ignatiev, Previti, Liffiton and Marques-Silva 2015). If the solver is
/// stopped, the best found so far.
MinimalSets smallest_set(GroupSolver& solver, const std::atomic<bool>* stop);

/// All minimal contradictions, at most `limit` (0: no limit), by exploring the subsets that no set
/// found before decides (Liffiton, Previti, Malik and Marques-Silva 2016). There can be
/// exponentially many.
MinimalSets all_minimal_sets(GroupSolver& solver, std::size_t limit, const std::atomic<bool>* stop);

/// The clauses behind one set of groups.
struct GroundContradiction {
  /// Indices into the model's clauses, by group and then by timepoint, definitions left out. None
  /// of them can be left out, unless the search was stopped or the effort spent (then `minimal` is
  /// false).
  std::vector<std::size_t> clauses;
  bool minimal = false;
  /// Report of the checker on a proof that these clauses contradict each other.
  ProofReport proof;
};

/// Finds ground instances of the groups' axioms that contradict each other. `groups` is a
/// contradictory set of `axioms`.
GroundContradiction ground_contradiction(ExecutionFormula& formula, const AxiomGroups& axioms,
                                         const IndexSet& groups, const ProofLimits& limits,
                                         Effort& effort);

}  // namespace parallax::runtime
