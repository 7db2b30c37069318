#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

struct WeightedFormula {
  FormulaId formula;
  std::int64_t weight = 1;  // counts where the formula is true
};

/// A sum of positive weights, and the number that it is compared with.
struct WeightedSum {
  std::vector<WeightedFormula> terms;
  std::int64_t total = 0;
  std::int64_t number = 0;
};

/// The same sum with positive weights and without constants; terms whose atoms exist from an
/// earlier horizon on come first. None: a number does not fit 64 bits.
std::optional<WeightedSum> weighted_sum(const GroundModel& model,
                                        const std::vector<WeightedFormula>& terms,
                                        std::int64_t number);

/// True where the sum compares so with its number. `spend(n)` is asked before n nodes are made;
/// where it is false the result means nothing.
FormulaId compare_sum(GroundModel& model, const WeightedSum& sum, CompareOp op,
                      const std::function<bool(std::size_t)>& spend);

}  // namespace parallax::compiler
