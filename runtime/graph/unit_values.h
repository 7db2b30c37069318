#pragma once

#include <cstdint>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// The values that unit propagation alone gives to variables, by variable - 1: 1, -1, or 0 where it
/// gives none. Stops at a contradiction. Linear in the clauses.
std::vector<std::int8_t> unit_values(const compiler::CompiledModel& model);

}  // namespace parallax::runtime
