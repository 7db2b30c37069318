#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compiler/formula/formula.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// `condition -> KIND(event, fluent, t)`, without variables.
struct EffectRow {
  EffectKind kind = EffectKind::kInitiates;
  std::uint32_t event = 0;
  std::uint32_t fluent = 0;
  FormulaId condition;
  std::uint32_t origin = 0;
};

/// The completed effect predicates: Initiates(e,f,t) holds iff some row of t for e and f has a
/// true condition. One list per timepoint, in order of axioms and instances.
class EffectRows {
 public:
  explicit EffectRows(std::int32_t timepoints) : rows_(static_cast<std::size_t>(timepoints)) {}
  void add(std::int32_t t, const EffectRow& row) {
    rows_[static_cast<std::size_t>(t)].push_back(row);
  }
  const std::vector<EffectRow>& at(std::int32_t t) const {
    return rows_[static_cast<std::size_t>(t)];
  }
  /// The effect predicate as a formula: the disjunction of the conditions.
  FormulaId holds(EffectKind kind, std::uint32_t event, std::uint32_t fluent, std::int32_t t,
                  FormulaStore& formulas) const;

 private:
  std::vector<std::vector<EffectRow>> rows_;
};

}  // namespace parallax::compiler
