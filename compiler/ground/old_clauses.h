#pragma once

#include <vector>

#include "compiler/formula/formula.h"

namespace parallax::compiler {

/// The clause form in which the 2005 reasoner looks for reasons: literals without repetition, a
/// literal beside its complement where the formula has both.
struct OldClauseForm {
  /// The reasoner names parts of the formula, because that takes fewer clauses: no `clauses` here.
  bool named = false;
  std::vector<std::vector<FormulaId>> clauses;
};

/// Distributes the formula unless that gives more clauses than naming every And and Or would
/// (two-way definitions). `store` keeps complements. Linear in the formula and its clauses.
OldClauseForm old_clause_form(const FormulaStore& store, FormulaId formula);

}  // namespace parallax::compiler
