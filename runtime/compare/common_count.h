#pragma once

#include <gmpxx.h>

#include <optional>

#include "runtime/graph/trace_graph.h"

namespace parallax::runtime {

/// The number of traces that both graphs have. They are compared by the names of what is true, so
/// both models must have the same ground fluents and events. Cost: pairs of nodes that a common
/// prefix reaches, times their edges.
mpz_class count_common(const TraceGraph& first, const compiler::CompiledModel& first_model,
                       const TraceGraph& second, const compiler::CompiledModel& second_model);

}  // namespace parallax::runtime
