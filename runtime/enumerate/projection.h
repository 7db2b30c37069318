#pragma once

#include <vector>

#include "compiler/artifact/literal.h"
#include "runtime/enumerate/trace_source.h"

namespace parallax::runtime {

using compiler::Literal;

/// The atoms that tell traces apart, in blocks: the state at 0; then for every timepoint t the
/// events at t and the state at t + 1; at last, if they count, the user predicates. One after the
/// other the blocks are in canonical order.
std::vector<std::vector<Literal>> projection_blocks(const CompiledModel& model, Distinct distinct);

}  // namespace parallax::runtime
