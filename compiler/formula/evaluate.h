#pragma once

#include <cstdint>
#include <functional>

#include "compiler/formula/formula.h"

namespace parallax::compiler {

enum class Truth : std::uint8_t { kFalse, kTrue, kUnknown };

/// The formula's value where some atoms are known (Kleene's strong three-valued logic). Linear in
/// the formula's graph.
Truth evaluate(const FormulaStore& store, FormulaId formula,
               const std::function<Truth(std::int32_t)>& atom);

}  // namespace parallax::compiler
