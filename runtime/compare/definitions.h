#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// How the value of a variable follows from the observed ones.
enum class Role : std::uint8_t {
  kObserved,
  kConstant,  // the same in every valuation that satisfies the model
  kGate,      // an auxiliary: the conjunction of its `children`
  kForced,    // true where a positive clause (or false where a negative one) leaves no choice
  kFree       // not determined, or not seen to be
};

struct Definition {
  Role role = Role::kFree;
  bool value = false;                       // kConstant; kForced: the polarity of the clauses
  std::vector<compiler::Literal> children;  // kGate
  std::vector<std::size_t> clauses;         // kForced: they contain the variable, the rest is known
};

/// A function for every variable of a model, such that for all values of the observed variables:
/// if some values of the others satisfy the model, then some values of the free variables do
/// together with what the functions give for all others. (Skolem functions; gates are those of
/// Plaisted and Greenbaum 1986, definability as in Padoa 1901 is decided by the solver.)
struct Definitions {
  std::vector<Definition> of;        // by variable - 1
  std::vector<std::int32_t> order;   // gates, forced and free variables, what they need first
  std::vector<std::int32_t> free;    // free variables, ascending
  std::vector<bool> is_gate_clause;  // by clause: satisfied by the functions, whatever is observed
};

/// `observed`: by variable - 1. Variables that the model does not force in an order of timepoints
/// that the search tries are taken for free, which is never wrong. `stop` may be null; when it is
/// raised all that is open becomes free. Costs solver calls if variables other than auxiliaries are
/// neither observed nor constant: some for each timepoint.
Definitions find_definitions(const compiler::CompiledModel& model,
                             const std::vector<bool>& observed, const std::atomic<bool>* stop);

}  // namespace parallax::runtime
