// A sum of weights, compared with a number, as a sequential counter (Sinz 2005).
//
// "The first i terms weigh k or more" is true if the first i-1 do, or if term i is true and the
// first i-1 weigh at least k less its weight. These formulas are the registers of the counter;
// those that are true or false by the weights alone are left out, which makes of a sum with
// unequal weights a decision diagram (Een and Sorensson 2006). They are ordinary formulas, so
// the clauses come from the clause builder, each register defined in the directions in which it
// is used.
//
// Terms stand in the order of the horizons that they need. What is left of a denied register at
// an earlier horizon then says that the terms which exist there weigh too little: a bound from
// above holds in every beginning of a trace.
//
// Cost: at most n registers for each number up to the bound, and no more than there are
// different sums of the last terms.

#include "compiler/ground/weighted_sum.h"

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <utility>

namespace parallax::compiler {
namespace {

constexpr auto kGreatestNumber = std::numeric_limits<std::int64_t>::max();

class Counter {
 public:
  Counter(FormulaStore& formulas, const WeightedSum& sum,
          const std::function<bool(std::size_t)>& spend)
      : formulas_(formulas), sum_(sum), spend_(spend), total_(sum.terms.size() + 1, 0) {
    for (std::size_t i = 0; i < sum.terms.size(); ++i) {
      total_[i + 1] = total_[i] + sum.terms[i].weight;
    }
  }

  FormulaId at_least(std::int64_t number) {
    const auto wanted = registers(number);
    if (!wanted) return formulas_.falsity();
    Registers before;
    for (std::size_t i = 1; i < wanted->size(); ++i) {
      const auto& [formula, weight] = sum_.terms[i - 1];
      Registers made;
      for (const auto bound : (*wanted)[i]) {
        const auto without = value(i - 1, bound, before);
        const auto with = formulas_.conjunction(formula, value(i - 1, bound - weight, before));
        made.emplace(bound, ~formulas_.kept_conjunction(~without, ~with));
      }
      before = std::move(made);
    }
    return value(sum_.terms.size(), number, before);
  }

 private:
  using Registers = std::unordered_map<std::int64_t, FormulaId>;  // by bound; look-up only

  bool is_open(std::size_t count, std::int64_t bound) const {
    return bound > 0 && bound <= total_[count];
  }

  /// By number of terms: the bounds that the registers behind it ask about. None: too many.
  std::optional<std::vector<std::vector<std::int64_t>>> registers(std::int64_t number) const {
    std::vector<std::vector<std::int64_t>> wanted(sum_.terms.size() + 1);
    if (is_open(sum_.terms.size(), number)) wanted.back().push_back(number);
    for (auto i = sum_.terms.size(); i > 0; --i) {
      if (!spend_(wanted[i].size())) return std::nullopt;
      auto& below = wanted[i - 1];
      for (const auto bound : wanted[i]) {
        for (const auto next : {bound, bound - sum_.terms[i - 1].weight}) {
          if (is_open(i - 1, next)) below.push_back(next);
        }
      }
      std::sort(below.begin(), below.end());
      below.erase(std::unique(below.begin(), below.end()), below.end());
    }
    return wanted;
  }

  FormulaId value(std::size_t count, std::int64_t bound, const Registers& made) const {
    return is_open(count, bound) ? made.at(bound) : formulas_.constant(bound <= 0);
  }

  FormulaStore& formulas_;
  const WeightedSum& sum_;
  const std::function<bool(std::size_t)>& spend_;
  std::vector<std::int64_t> total_;  // by number of terms
};

}  // namespace

std::optional<WeightedSum> weighted_sum(const GroundModel& model,
                                        const std::vector<WeightedFormula>& terms,
                                        std::int64_t number) {
  const auto& formulas = model.formulas();
  WeightedSum sum{{}, 0, number};
  std::vector<std::pair<Timepoint, WeightedFormula>> ordered;
  for (const auto& [formula, weight] : terms) {
    if (formula == formulas.falsity() || weight == 0) continue;
    // A weight below 0 is one above 0 for the negation, and a constant.
    const bool constant = weight < 0 || formula == formulas.truth();
    if (constant && __builtin_sub_overflow(sum.number, weight, &sum.number)) return std::nullopt;
    if (formula == formulas.truth()) continue;
    if (weight == std::numeric_limits<std::int64_t>::min()) return std::nullopt;
    const auto magnitude = weight < 0 ? -weight : weight;
    if (__builtin_add_overflow(sum.total, magnitude, &sum.total)) return std::nullopt;
    ordered.push_back(
        {model.needed_horizon_of(formula), {weight < 0 ? ~formula : formula, magnitude}});
  }
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [needed, term] : ordered) sum.terms.push_back(term);
  return sum;
}

FormulaId compare_sum(GroundModel& model, const WeightedSum& sum, CompareOp op,
                      const std::function<bool(std::size_t)>& spend) {
  auto& formulas = model.formulas();
  Counter counter(formulas, sum, spend);
  const auto at_least = [&] { return counter.at_least(sum.number); };
  const auto above = [&] {
    return sum.number == kGreatestNumber ? formulas.falsity() : counter.at_least(sum.number + 1);
  };
  switch (op) {
    case CompareOp::kGreaterEqual:
      return at_least();
    case CompareOp::kLess:
      return ~at_least();
    case CompareOp::kGreater:
      return above();
    case CompareOp::kLessEqual:
      return ~above();
    case CompareOp::kEqual:
    case CompareOp::kNotEqual:
      break;
  }
  const auto equal = formulas.conjunction(at_least(), ~above());
  return op == CompareOp::kEqual ? equal : ~equal;
}

}  // namespace parallax::compiler
