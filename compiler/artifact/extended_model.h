#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::compiler {

/// Where literals of a model stand once further fixed variables lie behind its own: the slots of
/// timepoints move up. Numbers behind the model's last variable mean the added ones, in order.
class FixedInsertion {
 public:
  FixedInsertion(const CompiledModel& model, std::size_t added)
      : base_(model.base()),
        last_(model.variable_count()),
        added_(static_cast<std::int32_t>(added)) {}
  Literal operator()(Literal literal) const {
    auto variable = literal.var();
    if (variable > last_) {
      variable += base_ - last_;
    } else if (variable > base_) {
      variable += added_;
    }
    const auto moved = Literal::positive(variable);
    return literal.is_positive() ? moved : ~moved;
  }

 private:
  std::int32_t base_, last_, added_;
};

struct AddedClause {
  std::vector<Literal> literals;
  Timepoint needed = 0;  // the horizon that its atoms need
  bool is_definition = false;
};

/// The model with these fixed variables and, in a section of their own that has `origin`, these
/// clauses. Their literals, as those of a FixedInsertion, mean the added variables by numbers
/// behind the model's last one. Linear in the clauses.
CompiledModel extended_model(const CompiledModel& model, const std::vector<Atom>& fixed,
                             const std::vector<AddedClause>& clauses, const Origin& origin);

}  // namespace parallax::compiler
