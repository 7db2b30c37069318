#pragma once

#include "compiler/reference/reference_evaluator.h"
#include "runtime/trace/trace.h"

namespace parallax::tools {

/// A trace in the form that the reference evaluator takes.
inline compiler::Valuation valuation_of(const runtime::Trace& trace) {
  compiler::Valuation valuation;
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    const auto holds = trace.holds(t), happens = trace.happens(t), released = trace.released(t);
    valuation.holds.emplace_back(holds.begin(), holds.end());
    valuation.happens.emplace_back(happens.begin(), happens.end());
    valuation.released.emplace_back(released.begin(), released.end());
  }
  valuation.predicates.insert(trace.predicates.begin(), trace.predicates.end());
  return valuation;
}

}  // namespace parallax::tools
