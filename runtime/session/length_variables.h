#pragma once

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// Variables beyond those of a model, by which its clauses and what is looked for are bound to a
/// length. Enumerators and the formula that a proof refutes number them alike.
class LengthVariables {
 public:
  explicit LengthVariables(const compiler::CompiledModel& model)
      : first_(model.variable_count()), horizon_(model.horizon) {}

  /// The clauses of timepoint t, 1 .. horizon, hold.
  compiler::Literal reaches(compiler::Timepoint t) const { return at(t); }
  /// A trace of a model with state constraints ends at n, 0 .. horizon.
  compiler::Literal ends(compiler::Timepoint n) const { return at(horizon_ + 1 + n); }
  /// It does not end within the horizon.
  compiler::Literal goes_on() const { return at(2 * horizon_ + 2); }
  /// The last of these variables.
  std::int32_t last() const { return first_ + 2 * horizon_ + 2; }

 private:
  compiler::Literal at(std::int32_t i) const { return compiler::Literal::positive(first_ + i); }
  std::int32_t first_;
  compiler::Timepoint horizon_;
};

}  // namespace parallax::runtime
