#include "harness/campaign/result_json.h"

#include <nlohmann/json.hpp>

#include "compiler/base/json.h"

namespace parallax::harness {
std::string criterion_json(const CriterionSpec& criterion) {
  const auto& paper = criterion.paper;
  nlohmann::ordered_json out = {{"kind", to_string(criterion.kind)},
                                {"confidence", criterion.confidence_level},
                                {"epsilon", criterion.epsilon},
                                {"family", to_string(criterion.family)},
                                {"paper",
                                 {{"preset", paper.preset},
                                  {"sigma", kSigmaWords.of(paper.sigma)},
                                  {"root", kRootWords.of(paper.root)},
                                  {"intercept", kInterceptWords.of(paper.intercept)},
                                  {"interval", kIntervalWords.of(paper.interval)},
                                  {"extra_runs", paper.extra_runs},
                                  {"exempt_inherited", paper.exempt_inherited},
                                  {"tolerance_m", paper.tolerance_m},
                                  {"bonferroni", paper.bonferroni}}}};
  if (criterion.runs > 0) out["runs"] = criterion.runs;
  return base::json_text(out);
}

}  // namespace parallax::harness
