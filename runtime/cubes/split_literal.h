#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "runtime/enumerate/clause_propagation.h"

namespace parallax::runtime {

/// Looks for variables by which a question falls into two that are both easier: that by unit
/// propagation fix much, whichever value they get (lookahead: Heule and van Maaren 2009).
class SplitLiteral {
 public:
  /// `clauses`: literals as of DIMACS, each clause closed by 0.
  SplitLiteral(std::int32_t variables, std::span<const std::int32_t> clauses);

  /// The positive literal of a variable that `assumed` leaves open, by the product of the numbers
  /// of literals that its two values fix; none: nothing is left, or `assumed` cannot hold.
  /// `is_fixed`: literals that hold in any case. Of many variables some thousand are tried, evenly
  /// over their numbers and so over the timepoints. The first one of equals.
  std::optional<Literal> best(std::span<const Literal> assumed,
                              const std::function<bool(Literal)>& is_fixed);

 private:
  using Code = ClausePropagation::Code;
  bool hold(Code code);
  /// How many literals it fixes; 0: it cannot hold. Nothing stays set.
  std::size_t reach(Code code);
  std::optional<Code> best_open();
  std::int32_t variables_;
  ClausePropagation propagation_;
  std::vector<Code> units_;
  bool is_consistent_ = true;
};

}  // namespace parallax::runtime
