#pragma once

#include <cstdint>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/explain/minimal_sets.h"
#include "runtime/proof/check_proof.h"

namespace parallax::runtime {

/// The clauses behind one set of groups.
struct GroundContradiction {
  /// Indices into the model's clauses, by group and then by timepoint, definitions left out: no one
  /// of them can go, unless the search was stopped or the effort spent (then `minimal` is false).
  std::vector<std::size_t> clauses;
  bool minimal = false;
  /// What the checker says of a proof that these clauses contradict each other.
  ProofReport proof;
};

/// Finds ground instances of the groups' axioms that contradict each other. `groups` is a
/// contradictory set of `axioms`.
GroundContradiction ground_contradiction(ExecutionFormula& formula, const AxiomGroups& axioms,
                                         const IndexSet& groups, const ProofLimits& limits,
                                         Effort& effort);

}  // namespace parallax::runtime
