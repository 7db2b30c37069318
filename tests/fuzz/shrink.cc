#include <utility>

#include "tests/fuzz/differential.h"

namespace parallax::test {
namespace {

/// Every tree that has one part of `formula` in the place of the node above it.
void smaller_formulas(const RandomFormula& formula, std::vector<RandomFormula>& out) {
  for (const auto& part : formula.parts) out.push_back(part);
  for (std::size_t i = 0; i < formula.parts.size(); ++i) {
    std::vector<RandomFormula> inner;
    smaller_formulas(formula.parts[i], inner);
    for (auto& candidate : inner) {
      out.push_back(formula);
      out.back().parts[i] = std::move(candidate);
    }
  }
}

class Shrinker {
 public:
  Shrinker(RandomModel model, const Comparison& difference, const DifferentialOptions& options)
      : model_(std::move(model)), difference_(difference), options_(options) {}

  RandomModel run() {
    while (drop_statement() || shrink_formula() || drop_label()) {
    }
    return std::move(model_);
  }

 private:
  /// Keeps the candidate if it still shows the difference.
  bool accept(RandomModel candidate) {
    const auto found = compare_oracles(candidate.print(), options_);
    if (found.kind != Comparison::Kind::kDiffer || found.code != difference_.code) return false;
    model_ = std::move(candidate);
    return true;
  }

  bool drop_statement() {
    bool any = false;
    for (std::size_t i = model_.statements.size(); i-- > 0;) {
      auto candidate = model_;
      candidate.statements.erase(candidate.statements.begin() + static_cast<std::ptrdiff_t>(i));
      any = accept(std::move(candidate)) || any;
    }
    return any;
  }

  bool shrink_formula() {
    for (std::size_t i = 0; i < model_.statements.size(); ++i) {
      if (!model_.statements[i].formula) continue;
      std::vector<RandomFormula> formulas;
      smaller_formulas(*model_.statements[i].formula, formulas);
      for (auto& formula : formulas) {
        auto candidate = model_;
        candidate.statements[i].formula = std::move(formula);
        if (accept(std::move(candidate))) return true;
      }
    }
    return false;
  }

  bool drop_label() {
    for (std::size_t i = 0; i < model_.statements.size(); ++i) {
      if (model_.statements[i].label.empty()) continue;
      auto candidate = model_;
      candidate.statements[i].label.clear();
      if (accept(std::move(candidate))) return true;
    }
    return false;
  }

  RandomModel model_;
  const Comparison& difference_;
  const DifferentialOptions& options_;
};

}  // namespace

RandomModel shrink(RandomModel model, const Comparison& difference,
                   const DifferentialOptions& options) {
  return Shrinker(std::move(model), difference, options).run();
}

}  // namespace parallax::test
