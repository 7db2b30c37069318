#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "compiler/base/diagnostic.h"
#include "compiler/reference/reference_evaluator.h"
#include "runtime/trace/trace.h"

namespace parallax::tools {

/// `--check`: checks traces with the reference evaluator, which shares no code with the search for
/// them. Standard meaning only. A plan's control flow and the state constraints of a scenario are
/// not part of the model and are not checked.
class TraceCheck {
 public:
  /// All three outlive the check; raising `stop`, which may be null, ends it early.
  TraceCheck(const compiler::TypedModel& typed, const std::atomic<bool>* stop,
             base::DiagnosticSink& sink)
      : typed_(typed), stop_(stop), sink_(sink) {}

  /// Reports E7201 for a trace that does not satisfy the model, with its further violations as
  /// notes; E7202, once, where the model is too large for the check.
  void check(const runtime::Trace& trace);
  /// The traces that were checked to the end, whatever the outcome.
  std::int64_t checked() const { return checked_; }
  bool agreed() const { return !disagreed_ && !given_up_; }

 private:
  void give_up(const runtime::Trace& trace, const std::string& reason);
  void report(const runtime::Trace& trace, const std::vector<compiler::Violation>& violations);

  const compiler::TypedModel& typed_;
  const std::atomic<bool>* stop_;
  base::DiagnosticSink& sink_;
  std::unique_ptr<compiler::ReferenceEvaluator> evaluator_;  // made for the first trace
  std::int64_t checked_ = 0;
  bool disagreed_ = false, given_up_ = false;
};

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
