#include "compiler/reference/reference_use.h"

#include <algorithm>

namespace parallax::compiler {

std::set<std::size_t> ReferenceSearch::fired_effects() const {
  std::set<std::size_t> fired;
  for (std::int64_t t = 0; t < last_; ++t) {
    for (std::uint32_t f = 0; f < expanded_.fluents().size(); ++f) {
      for (const auto& row : expanded_.rows(f, t)) {
        if (fires(row, t) == Truth::kTrue) fired.insert(row.effect);
      }
    }
  }
  return fired;
}

ReferenceUse::ReferenceUse(const ReferenceEvaluator& evaluator) : evaluator_(evaluator) {
  const auto& expanded = evaluator.expanded();
  std::vector<bool> is_event(expanded.atom_count(), false);
  for (std::int64_t t = 0; t < expanded.horizon(); ++t) {
    for (std::uint32_t e = 0; e < expanded.events().size(); ++e) {
      is_event[expanded.happens(e, t)] = true;
    }
  }
  for (const auto& conjunct : expanded.conjuncts()) {
    for (const auto atom : expanded.trees().atoms_of(conjunct.formula.node)) {
      if (is_event[atom]) mentions_.emplace_back(atom, conjunct.axiom);
    }
  }
  std::sort(mentions_.begin(), mentions_.end());
  mentions_.erase(std::unique(mentions_.begin(), mentions_.end()), mentions_.end());
}

ReferenceUse::Axioms ReferenceUse::of(const Valuation& valuation) const {
  const auto& expanded = evaluator_.expanded();
  const auto last =
      std::min(static_cast<std::int64_t>(valuation.holds.size()) - 1, expanded.horizon());
  const auto values = evaluator_.values_of(valuation);
  Axioms use;
  use.effects = ReferenceSearch(evaluator_.model(), expanded, values, last).fired_effects();
  for (const auto& [atom, axiom] : mentions_) {
    if (values[atom] != 0) use.axioms.insert(axiom);
  }
  return use;
}

}  // namespace parallax::compiler
