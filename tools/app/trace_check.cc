#include "tools/app/trace_check.h"

#include "compiler/base/codes/campaigns.h"
#include "tools/app/trace_check.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kMaxViolations = 5;  // named for one trace

bool has_place(const base::SourceRange& range) { return range.end > range.begin; }

}  // namespace

void TraceCheck::check(const runtime::Trace& trace) {
  if (given_up_) return;
  if (!evaluator_) {
    compiler::ReferenceLimits limits;
    limits.stop = stop_;
    evaluator_ = std::make_unique<compiler::ReferenceEvaluator>(typed_, limits);
  }
  if (const auto reason = evaluator_->refusal()) return give_up(trace, *reason);
  const auto result = evaluator_->violations(valuation_of(trace), kMaxViolations);
  if (!result.violations.empty()) {
    report(trace, result.violations);
  } else if (!result.finished) {
    return give_up(trace, "looking for the reasons of completed atoms takes too long");
  }
  ++checked_;
}

void TraceCheck::give_up(const runtime::Trace& trace, const std::string& reason) {
  given_up_ = true;
  sink_.error_about(codes::kCheckGivenUp, "", trace.number, reason);
}

void TraceCheck::report(const runtime::Trace& trace,
                        const std::vector<compiler::Violation>& violations) {
  disagreed_ = true;
  const auto& first = violations.front();
  const auto code = codes::kTraceDisagrees;
  auto built = has_place(first.source) ? sink_.error(code, first.source, trace.number, first.text)
                                       : sink_.error_about(code, "", trace.number, first.text);
  for (std::size_t i = 1; i < violations.size(); ++i) {
    if (has_place(violations[i].source)) {
      built.note(violations[i].source, violations[i].text);
    } else {
      built.note(violations[i].text);
    }
  }
}

}  // namespace parallax::tools
