#include "tools/learn/rule_heads.h"

#include <algorithm>
#include <utility>

namespace parallax::tools {

namespace {

constexpr int kNewVariable = 2, kHeadConstant = 25;

}  // namespace

std::vector<LearnedRule> rule_heads(RuleKind kind, std::size_t event,
                                    const std::vector<std::size_t>& event_arguments,
                                    std::size_t fluent,
                                    const std::vector<std::size_t>& fluent_arguments,
                                    const LearnVocabulary& vocabulary) {
  LearnedRule bare;
  bare.kind = kind;
  bare.event = event;
  bare.fluent = fluent;
  bare.cost = kRuleCost;
  if (kind != RuleKind::kAdmits) bare.variables = vocabulary.symbols()[event].sorts;
  std::vector<LearnedRule> out = {bare};
  for (std::size_t i = 0; i < fluent_arguments.size(); ++i) {
    const auto sort = vocabulary.symbols()[fluent].sorts[i];
    std::vector<LearnedRule> next;
    for (const auto& begun : out) {
      for (std::size_t k = 0; k < event_arguments.size(); ++k) {
        if (event_arguments[k] != fluent_arguments[i]) continue;
        next.push_back(begun);
        next.back().terms.push_back({RuleTerm::Kind::kHead, k});
      }
      next.push_back(begun);
      next.back().terms.push_back({RuleTerm::Kind::kHead, begun.variables.size()});
      next.back().variables.push_back(sort);
      next.back().cost += kNewVariable;
      if (kind == RuleKind::kAdmits) continue;
      next.push_back(begun);
      next.back().terms.push_back({RuleTerm::Kind::kConstant, fluent_arguments[i]});
      next.back().cost += kHeadConstant;
    }
    out = std::move(next);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.cost < b.cost; });
  return out;
}

}  // namespace parallax::tools
