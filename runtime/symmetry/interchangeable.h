#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/symmetry/named_atoms.h"

namespace parallax::runtime {

/// Constants that a compiled model does not tell apart: exchanging any two of a set in all names
/// makes a trace of a trace. Found on the clauses, so a start state, a plan, a state constraint or
/// a goal that names one of them tells it apart.
struct Interchangeables {
  /// Each of two and more, in the order in which the model mentions them first.
  std::vector<std::vector<std::string>> sets;
  bool empty() const { return sets.empty(); }
};

/// An exchange of two constants, as the nodes that change places.
using NodeSwap = std::vector<std::pair<ModelNode, ModelNode>>;

/// The sets of a model; sets that it would take too long to find are left out. Deterministic.
class ModelSymmetry {
 public:
  explicit ModelSymmetry(const compiler::CompiledModel& model);
  const Interchangeables& constants() const { return constants_; }
  /// The exchanges of neighbours in each set: they generate all of them.
  const std::vector<NodeSwap>& swaps() const { return swaps_; }
  bool empty() const { return swaps_.empty(); }

 private:
  Interchangeables constants_;
  std::vector<NodeSwap> swaps_;
};

}  // namespace parallax::runtime
