#pragma once

#include "compiler/reference/reference_evaluator.h"
#include "runtime/trace/trace.h"

namespace parallax::tools {

/// A trace in the form that the reference evaluator takes.
inline compiler::Valuation valuation_of(const runtime::Trace& trace) {
  compiler::Valuation valuation;
  for (const auto& point : trace.points) {
    valuation.holds.emplace_back(point.holds.begin(), point.holds.end());
    valuation.happens.emplace_back(point.happens.begin(), point.happens.end());
    valuation.released.emplace_back(point.released.begin(), point.released.end());
  }
  valuation.predicates.insert(trace.predicates.begin(), trace.predicates.end());
  return valuation;
}

}  // namespace parallax::tools
