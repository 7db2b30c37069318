#pragma once

#include <cstdint>
#include <vector>

#include "compiler/ground/universe.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Instances of atoms and comparisons in a full expansion over all sorts; the greatest number
/// stands for all that is beyond 64 bits. Linear in the formula.
std::uint64_t expansion_size(const TypedModel& model, const Universe& universe,
                             TypedFormulaId formula);

/// Does some quantifier inside, with or without the root, range over nothing? Then atoms below it
/// have no instances, and say nothing of the timepoints that exist.
bool has_empty_quantifier(const TypedModel& model, const Universe& universe,
                          TypedFormulaId formula);

/// The expansion of `[variables] condition -> head`, which has one atom more.
std::uint64_t expansion_size(const TypedModel& model, const Universe& universe,
                             TypedFormulaId condition, const std::vector<VariableId>& variables);

}  // namespace parallax::compiler
