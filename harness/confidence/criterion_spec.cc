#include "harness/confidence/criterion_spec.h"

namespace parallax::harness {

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
