#include "harness/campaign/result_json.h"

#include <nlohmann/json.hpp>

#include "compiler/base/json.h"

namespace parallax::harness {
namespace {

const char* word(SigmaKind kind) {
  switch (kind) {
    case SigmaKind::kSse:
      return "sse";
    case SigmaKind::kRmse:
      return "rmse";
    case SigmaKind::kResidualSd:
      break;
  }
  return "residual-sd";
}

const char* word(InterceptKind kind) {
  switch (kind) {
    case InterceptKind::kNone:
      return "none";
    case InterceptKind::kCentred:
      return "centred";
    case InterceptKind::kFree:
      break;
  }
  return "free";
}

}  // namespace

std::string criterion_json(const CriterionSpec& criterion) {
  const auto& paper = criterion.paper;
  nlohmann::ordered_json out = {
      {"kind", to_string(criterion.kind)},
      {"confidence", criterion.confidence_level},
      {"epsilon", criterion.epsilon},
      {"family", to_string(criterion.family)},
      {"paper",
       {{"preset", paper.preset},
        {"sigma", word(paper.sigma)},
        {"root", paper.root == RootKind::kFinal ? "final" : "initial"},
        {"intercept", word(paper.intercept)},
        {"interval", paper.interval == IntervalKind::kPrediction ? "prediction" : "mean"},
        {"extra_runs", paper.extra_runs},
        {"exempt_inherited", paper.exempt_inherited},
        {"tolerance_m", paper.tolerance_m},
        {"bonferroni", paper.bonferroni}}}};
  if (criterion.runs > 0) out["runs"] = criterion.runs;
  return base::json_text(out);
}

}  // namespace parallax::harness
