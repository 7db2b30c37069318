#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "compiler/formula/formula.h"

namespace parallax::compiler {

/// `formula` with the atom `variable` replaced by a constant. Linear in the formula's graph.
FormulaId substitute(FormulaStore& store, FormulaId formula, std::int32_t variable, bool value);

}  // namespace parallax::compiler
