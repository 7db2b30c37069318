#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/symmetry/constant_group.h"
#include "runtime/symmetry/named_atoms.h"

namespace parallax::runtime {

/// Constants that a compiled model does not tell apart: replacing them in all names turns a trace
/// into a trace. Found on the clauses, so a start state, a plan, a state constraint or a goal that
/// names one of them tells it apart.
struct Interchangeables {
  /// Any two constants of a set can be exchanged. Each set has two or more, in the order in which
  /// the model mentions them first.
  std::vector<std::vector<std::string>> sets;
  /// Symmetries that move several constants at once and enlarge the group of the sets: by symmetry,
  /// its cycles, in each of which a constant takes the place of the one before it.
  std::vector<std::vector<std::vector<std::string>>> together;
  bool empty() const { return sets.empty() && together.empty(); }
};

/// A symmetry as pairs: a named node that it moves, and the node whose place it takes.
using NodeMap = std::vector<std::pair<ModelNode, ModelNode>>;

/// Images of the atoms that a symmetry of the constants moves. `map` must have been checked.
NodeMap moved_nodes(const NamedAtoms& atoms, const ConstantMap& map);

/// Effort of a search for symmetries of several constants at once.
enum class SymmetryEffort : std::uint8_t {
  kQuick,     // while nothing is known to be hard: some tenths of a second
  kThorough,  // some seconds
};

/// The symmetries of a model that permute constants. Deterministic. Each was checked clause by
/// clause; where finding all of them would take too long, some are left out.
class ModelSymmetry {
 public:
  explicit ModelSymmetry(const compiler::CompiledModel& model,
                         SymmetryEffort effort = SymmetryEffort::kThorough);
  const Interchangeables& constants() const { return constants_; }
  /// Generators of the group: exchanges of neighbours in each set, and those of several at once.
  std::span<const NodeMap> generators() const {
    return std::span(generators_).first(is_complete_ ? generators_.size() : exchanges_);
  }
  /// Includes those found by a search that was given up: for questions of existence.
  std::span<const NodeMap> all() const { return generators_; }
  bool empty() const { return generators_.empty(); }
  const ConstantGroup& group() const { return group_; }
  /// Lower bound on the number of symmetries.
  const mpz_class& known_order() const { return known_order_; }

 private:
  void find_sets(const compiler::CompiledModel& model, const NamedAtoms& atoms,
                 PermutationCheck& check);
  void add(const NamedAtoms& atoms, const ConstantMap& map);

  Interchangeables constants_;
  std::vector<NodeMap> generators_;
  std::size_t exchanges_ = 0;  // number that exchange two constants; they come first
  bool is_complete_ = true;
  bool is_settled_ = true;             // constants of different sets differ
  std::vector<std::uint32_t> set_of_;  // by constant
  ConstantGroup group_;
  mpz_class known_order_ = 1;
};

}  // namespace parallax::runtime
