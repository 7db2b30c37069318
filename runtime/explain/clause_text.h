#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// Writes clauses as a reader of the model would: atoms by their names, auxiliaries by their
/// definitions, a clause as an implication where it has negative literals.
class ClauseText {
 public:
  /// `model` outlives the object. Linear in the clauses.
  explicit ClauseText(const compiler::CompiledModel& model);

  /// `HoldsAt(F(),0)`; `!Happens(E(),1)`.
  std::string literal(compiler::Literal literal) const;
  /// `HoldsAt(F(),0) & !Happens(E(),0) -> HoldsAt(F(),1)`. Long clauses and deep definitions are
  /// cut short with `...`.
  std::string clause(std::size_t index) const;

  bool is_auxiliary(std::int32_t variable) const {
    return auxiliary_[static_cast<std::size_t>(variable)];
  }
  /// The clauses that define what an auxiliary literal implies.
  const std::vector<std::size_t>& definitions(compiler::Literal literal) const;

 private:
  struct Budget {
    int depth;
    int parts;  // literals that may still be written
  };
  std::vector<compiler::Literal> flattened(std::span<const compiler::Literal> literals) const;
  std::string formula(std::span<const compiler::Literal> literals, Budget& budget) const;
  std::string meaning(compiler::Literal literal, Budget& budget) const;

  const compiler::CompiledModel& model_;
  std::vector<bool> auxiliary_;  // by variable
  /// By DIMACS literal: definition clauses that begin with its complement. For look-up only.
  std::unordered_map<std::int32_t, std::vector<std::size_t>> definitions_;
};

}  // namespace parallax::runtime
