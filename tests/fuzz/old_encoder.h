#pragma once

#include <cstddef>
#include <string>

#include "compiler/sema/typed_model.h"
#include "tests/fuzz/oracles.h"

namespace parallax::test {

/// Models of a checked model according to the encoder of 2005.
struct OldAnswer {
  TraceList found;
  /// Empty, or why the rules give no answer here.
  std::string beyond;
};

/// A second implementation of the rules by which the Discrete Event Calculus Reasoner 1.0 encodes a
/// model: formulas are written out as trees over printed atoms, an instance with an atom that does
/// not exist is discarded by the innermost quantifier around it, simplification looks at constants
/// only, completion works on clauses, and an atom that is left in no formula is false. It shares
/// nothing with the grounder but the checked model. Where that program stops with an error although
/// its rules have an answer (a negated equivalence, a trajectory without events that begin and end
/// it), the rules are followed.
///
/// `mutex` and `xor` are written out from the statements, not from the axioms that the checker
/// makes of them: an argument's variable is its sort, numbered from 1 for each name.
OldAnswer old_encoder_traces(const compiler::TypedModel& model,
                             const std::vector<StatedExclusion>& exclusions, std::size_t limit);

}  // namespace parallax::test
