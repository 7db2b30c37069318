#include "harness/campaign/result_json.h"

#include <nlohmann/json.hpp>

#include "compiler/base/json.h"

namespace parallax::harness {
namespace {

template <typename Words, typename Enum>
std::string_view word(const Words& words, Enum value) {
  return words[static_cast<std::size_t>(value)];
}

}  // namespace

std::string criterion_json(const CriterionSpec& criterion) {
  const auto& paper = criterion.paper;
  nlohmann::ordered_json out = {{"kind", to_string(criterion.kind)},
                                {"confidence", criterion.confidence_level},
                                {"epsilon", criterion.epsilon},
                                {"family", to_string(criterion.family)},
                                {"paper",
                                 {{"preset", paper.preset},
                                  {"sigma", word(kSigmaWords, paper.sigma)},
                                  {"root", word(kRootWords, paper.root)},
                                  {"intercept", word(kInterceptWords, paper.intercept)},
                                  {"interval", word(kIntervalWords, paper.interval)},
                                  {"extra_runs", paper.extra_runs},
                                  {"exempt_inherited", paper.exempt_inherited},
                                  {"tolerance_m", paper.tolerance_m},
                                  {"bonferroni", paper.bonferroni}}}};
  if (criterion.runs > 0) out["runs"] = criterion.runs;
  return base::json_text(out);
}

}  // namespace parallax::harness
