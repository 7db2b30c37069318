#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "runtime/compare/circuit.h"
#include "runtime/compare/definitions.h"

namespace parallax::runtime {

/// A model's variables as literals of a circuit: observed and free ones as the caller says, the
/// others by their definitions.
class MappedModel {
 public:
  /// Both outlive the mapping. `given(v)` is asked for observed and free variables; without an
  /// answer the variable, and what depends on it, stays open.
  MappedModel(const compiler::CompiledModel& model, const Definitions& definitions,
              Circuit& circuit, const std::function<std::optional<Literal>(std::int32_t)>& given);

  /// None while the variable is open.
  std::optional<Literal> find(Literal literal) const;
  /// None if some of its variables are open.
  std::optional<Circuit::Clause> clause(std::size_t index) const;
  /// A copy in which the variables that are open have values: `free_value(v)` for free ones.
  MappedModel closed(const std::function<bool(std::int32_t)>& free_value) const;

 private:
  void define(std::int32_t variable);
  std::optional<Literal> gate(const Definition& definition) const;
  std::optional<Literal> forced(std::int32_t variable, const Definition& definition) const;

  const compiler::CompiledModel* model_;
  const Definitions* definitions_;
  Circuit* circuit_;
  std::vector<std::optional<Literal>> literals_;  // by variable - 1
};

}  // namespace parallax::runtime
