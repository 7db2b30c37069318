#pragma once

#include <doctest/doctest.h>

#include <set>
#include <string>
#include <vector>

#include "compiler/reference/reference_evaluator.h"
#include "runtime/enumerate/model_enumerator.h"
#include "tools/app/trace_check.h"

namespace parallax::test {

/// Holds every trace that a test enumerates against the reference evaluator. For the standard
/// meaning only. A disagreement fails the test with the axiom in question.
class TraceChecker {
 public:
  explicit TraceChecker(const compiler::TypedModel& typed) : evaluator_(typed) {
    REQUIRE_MESSAGE(!evaluator_.refusal(), *evaluator_.refusal());
  }
  void check(const runtime::Trace& trace) {
    const auto report = evaluator_.violations(tools::valuation_of(trace), 3);
    CHECK(report.finished);
    for (const auto& violation : report.violations) {
      FAIL_CHECK("trace " << trace.number << ": " << violation.text);
    }
    ++checked_;
  }
  std::int64_t checked() const { return checked_; }
  const compiler::ReferenceEvaluator& evaluator() const { return evaluator_; }

 private:
  compiler::ReferenceEvaluator evaluator_;
  std::int64_t checked_ = 0;
};

/// All traces of a model in the enumerator's order, each checked.
inline std::vector<runtime::Trace> checked_traces(const compiler::TypedModel& typed,
                                                  const compiler::CompiledModel& compiled) {
  TraceChecker checker(typed);
  runtime::SolverSession session(compiled, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  std::vector<runtime::Trace> traces;
  while (auto trace = enumerator.next()) {
    checker.check(*trace);
    traces.push_back(*std::move(trace));
  }
  return traces;
}

/// The observable part of a trace as one line: "F() ;;|E() ;;|", timepoints closed by `;`.
inline std::string signature(const compiler::Valuation& valuation) {
  std::string out;
  for (const auto* part : {&valuation.holds, &valuation.happens}) {
    for (const auto& point : *part) {
      for (const auto& atom : point) out += atom + ' ';
      out += ';';
    }
    out += '|';
  }
  return out;
}

}  // namespace parallax::test
