#include "harness/confidence/criterion.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/base/contract.h"
#include "harness/confidence/clean_runs.h"
#include "harness/confidence/criterion_spec.h"

namespace parallax::harness {

CertifiedBound certified_bound(const Tally& tally, double confidence_level) {
  const std::int64_t failures = tally.lost() + tally.mismatch();
  if (failures == 0) return {confidence_level, bound_after(tally.clean(), confidence_level)};
  return {std::max(0.0, 1.0 - 2.0 * (1.0 - confidence_level)),
          mixture_upper(failures, tally.runs(), confidence_level)};
}

CleanRunsCriterion::CleanRunsCriterion(double confidence_level, double epsilon)
    : confidence_level_(confidence_level),
      epsilon_(epsilon),
      runs_needed_(harness::runs_needed(confidence_level, epsilon)) {}

Decision CleanRunsCriterion::decide(const Tally& tally) const {
  Decision decision;
  decision.certified = certified_bound(tally, confidence_level_);
  if (tally.mismatch() > 0) {
    decision.why = "a run gave a discrepancy";
    return decision;
  }
  // All-clean runs have their own bound, which is shorter but does not survive a failure.
  const bool all_clean = tally.lost() == 0;
  const std::int64_t needed =
      all_clean ? runs_needed_ : mixture_runs_needed(tally.lost(), confidence_level_, epsilon_);
  decision.runs_needed = needed;
  decision.stop = tally.runs() >= needed;
  decision.why = fmt::format("{} of {} runs{}", tally.runs(), needed,
                             all_clean ? "" : fmt::format(", {} lost", tally.lost()));
  return decision;
}

PaperCriterion::PaperCriterion(double confidence_level, PaperRuleSpec spec)
    : confidence_level_(confidence_level), spec_(std::move(spec)) {
  PARALLAX_REQUIRE(confidence_level > 0.0 && confidence_level < 1.0, "a confidence in (0, 1)");
}

Decision PaperCriterion::decide(const Tally& tally) const {
  Decision decision;
  decision.certified = certified_bound(tally, confidence_level_);
  if (tally.mismatch() > 0) {
    decision.why = "a run gave a discrepancy";
    return decision;
  }
  if (tally.lost() > 0) {
    // The rule has no place for a run without a result; leaving it out would favour the model.
    decision.why = "a run was lost";
    return decision;
  }
  decision.paper = paper_rule(tally, spec_, confidence_level_);
  decision.stop = decision.paper->stop;
  decision.why = decision.stop ? "every final interval lies in its cell" : decision.paper->why_not;
  return decision;
}

std::unique_ptr<ConfidenceCriterion> make_criterion(const CriterionSpec& spec) {
  switch (spec.kind) {
    case CriterionKind::kCleanRuns:
      return std::make_unique<CleanRunsCriterion>(spec.confidence_level, spec.epsilon);
    case CriterionKind::kPaper:
      return std::make_unique<PaperCriterion>(spec.confidence_level, spec.paper);
  }
  PARALLAX_REQUIRE(false, "a known kind of criterion");
  return nullptr;
}

PaperRuleSpec paper_literal() { return {}; }

PaperRuleSpec paper_repaired() {
  PaperRuleSpec spec;
  spec.sigma = SigmaKind::kResidualSd;
  spec.root = RootKind::kFinal;
  spec.intercept = InterceptKind::kFree;
  spec.interval = IntervalKind::kPrediction;
  spec.extra_runs = 2;
  spec.exempt_inherited = true;
  spec.tolerance_m = 0.01;
  spec.preset = "paper-repaired";
  return spec;
}

}  // namespace parallax::harness
