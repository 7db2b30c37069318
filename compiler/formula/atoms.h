#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compiler/formula/formula.h"

namespace parallax::compiler {

/// The variables that occur in any of the formulas, ascending. Linear in their common graph.
std::vector<std::int32_t> atoms_of(const FormulaStore& store, std::span<const FormulaId> formulas);

/// The variables that occur under an even number of negations, ascending.
std::vector<std::int32_t> positive_atoms(const FormulaStore& store, FormulaId formula);

}  // namespace parallax::compiler
