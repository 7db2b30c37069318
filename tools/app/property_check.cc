#include "tools/app/property_check.h"

#include <algorithm>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/words.h"
#include "compiler/reference/temporal_truth.h"
#include "tools/app/trace_check.h"

namespace parallax::tools {

std::optional<PropertyBreak> PropertyCheck::broken(const runtime::Trace& trace) {
  compiler::ReferenceLimits limits;
  limits.stop = &context_.stop();
  compiler::TemporalTruth truth(typed_, limits);
  const auto formula = property_.formula.formula;
  const auto time = property_.formula.time;
  const auto valuation = valuation_of(trace);
  const auto refused = [&] {
    const auto reason = truth.refusal();
    if (reason && strict_) {
      context_.sink().error_about(codes::kCheckGivenUp, "", trace.number, *reason);
    }
    return reason.has_value();
  };
  if (refused()) return std::nullopt;
  const auto values = truth.values(formula, time, valuation);
  if (refused()) return std::nullopt;
  // A formula that only looks back is to hold at all timepoints.
  const auto end = compiler::only_looks_back(typed_, formula) ? values.end() : values.begin() + 1;
  const auto found = std::find(values.begin(), end, std::optional(false));
  if (found == end) {
    context_.sink().error_about(codes::kTraceDisagrees, "", trace.number,
                                "the property is true of it");
    return std::nullopt;
  }
  const auto why = truth.why_false(formula, found - values.begin(), time, valuation);
  if (refused()) return std::nullopt;
  return PropertyBreak{base::one_line(context_.files().text(why.formula)), why.at, why.text};
}

}  // namespace parallax::tools
