#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>

#include "compiler/formula/formula.h"

namespace parallax::compiler {

/// What became of the nodes already rewritten, by node, sign left out.
using RewriteMemo = std::unordered_map<std::uint32_t, FormulaId>;

/// `formula` with every atom replaced by what `atom` says of its variable. Linear in the formula's
/// graph; calls with the same memo share the work.
FormulaId rewrite_atoms(FormulaStore& store, FormulaId formula,
                        const std::function<FormulaId(std::int32_t)>& atom, RewriteMemo& memo);

/// `formula` with the atom `variable` replaced by a constant. Linear in the formula's graph.
FormulaId substitute(FormulaStore& store, FormulaId formula, std::int32_t variable, bool value);

}  // namespace parallax::compiler
