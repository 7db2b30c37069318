#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "compiler/artifact/literal.h"
#include "compiler/base/known.h"

namespace parallax::compiler {

/// A node of the shared formula graph, with its sign in the low bit: negation costs nothing.
class FormulaId {
 public:
  constexpr FormulaId() = default;
  constexpr bool negated() const { return (bits_ & 1U) != 0; }
  constexpr std::uint32_t node() const { return bits_ >> 1U; }
  constexpr FormulaId operator~() const { return FormulaId(bits_ ^ 1U); }
  constexpr std::uint32_t bits() const { return bits_; }
  friend constexpr bool operator==(FormulaId, FormulaId) = default;
  friend constexpr auto operator<=>(FormulaId, FormulaId) = default;  // order of creation

 private:
  friend class FormulaStore;
  constexpr explicit FormulaId(std::uint32_t bits) : bits_(bits) {}
  std::uint32_t bits_ = 0;
};

enum class FormulaNodeKind : std::uint8_t { kTrue, kAtom, kAnd };

/// Hash-consed propositional formulas. The only connective is n-ary And (Or is its complement),
/// children sorted by id and unique; constants, duplicates and complements are resolved when a
/// node is made, and a conjunction inside a conjunction is spliced in. Equal formulas have equal
/// ids. Atoms are SAT variables.
class FormulaStore {
 public:
  FormulaStore();
  /// From now on `F & !F` and `F | !F` stay as they are written: where it matters which atoms a
  /// formula mentions, only its constants may decide it.
  void keep_complements() { keeps_complements_ = true; }
  FormulaId truth() const { return FormulaId(0); }
  FormulaId falsity() const { return FormulaId(1); }
  FormulaId constant(bool value) const { return value ? truth() : falsity(); }
  FormulaId atom(std::int32_t variable);
  FormulaId conjunction(std::vector<FormulaId> parts);
  FormulaId disjunction(std::vector<FormulaId> parts);
  FormulaId conjunction(FormulaId a, FormulaId b) { return conjunction(std::vector{a, b}); }
  FormulaId disjunction(FormulaId a, FormulaId b) { return disjunction(std::vector{a, b}); }
  /// The conjunction of two formulas as a node of its own, not spliced into others: formulas that
  /// share long chains of them, as counters do, stay small.
  FormulaId kept_conjunction(FormulaId a, FormulaId b);
  FormulaId implication(FormulaId a, FormulaId b) { return disjunction(~a, b); }
  FormulaId equivalence(FormulaId a, FormulaId b);

  FormulaNodeKind kind(FormulaId id) const { return nodes_[id.node()].kind; }
  std::int32_t variable(FormulaId id) const { return nodes_[id.node()].variable; }
  /// Children of the And node behind `id`, whatever its sign. Valid until the next construction.
  std::span<const FormulaId> children(FormulaId id) const;
  bool is_kept(FormulaId id) const { return nodes_[id.node()].kept; }
  std::size_t node_count() const { return nodes_.size(); }
  /// The formula of a node in order of construction: children come before their parents.
  FormulaId at(std::uint32_t node) const { return FormulaId(node << 1U); }

 private:
  struct Node {
    FormulaNodeKind kind = FormulaNodeKind::kTrue;
    std::int32_t variable = 0;
    std::uint32_t first_child = 0, child_count = 0;
    bool kept = false;
  };
  FormulaId intern_and(const std::vector<FormulaId>& children);
  void grow_table();
  std::size_t slot_of(std::span<const FormulaId> children, std::size_t hash) const;

  std::vector<Node> nodes_;
  std::vector<FormulaId> child_pool_;
  std::vector<std::uint32_t> atom_nodes_;  // by variable; 0 means none
  std::vector<std::uint32_t> table_;       // open addressing over And nodes; 0 means empty
  std::size_t and_count_ = 0;
  bool keeps_complements_ = false;
};

/// The variables that occur in any of the formulas, ascending. Linear in their common graph.
std::vector<std::int32_t> atoms_of(const FormulaStore& store, std::span<const FormulaId> formulas);

/// The variables that occur under an even number of negations, ascending.
std::vector<std::int32_t> positive_atoms(const FormulaStore& store, FormulaId formula);

using base::Truth;

/// The formula's value where some atoms are known (Kleene's strong three-valued logic). Linear in
/// the formula's graph.
Truth evaluate(const FormulaStore& store, FormulaId formula,
               const std::function<Truth(std::int32_t)>& atom);

/// Rewritten formula of each node done so far, by node, sign left out.
using RewriteMemo = std::unordered_map<std::uint32_t, FormulaId>;

/// `formula` with every atom replaced by what `atom` says of its variable. Linear in the formula's
/// graph; calls with the same memo share the work.
FormulaId rewrite_atoms(FormulaStore& store, FormulaId formula,
                        const std::function<FormulaId(std::int32_t)>& atom, RewriteMemo& memo);

/// `formula` with the atom `variable` replaced by a constant. Linear in the formula's graph.
FormulaId substitute(FormulaStore& store, FormulaId formula, std::int32_t variable, bool value);

/// Formulas as text for people: `a & (b | !c)`. A part that occurs in several places is written
/// `#1` there and defined once, so that the text is linear in the formulas' graph. No recursion.
class FormulaText {
 public:
  /// `store` outlives the object.
  FormulaText(const FormulaStore& store, std::function<std::string(std::int32_t)> atom_name);

  /// Notes the places of a formula's parts; call for every formula before the first text.
  void count(FormulaId formula);
  std::string text(FormulaId formula);
  /// The parts that the texts so far have named, and those that these name: `#1 = b | !c`, a line
  /// each.
  std::string definitions();

 private:
  /// The store may have grown since the last call.
  void know_nodes();
  std::string part_name(FormulaId id);

  const FormulaStore& store_;
  std::function<std::string(std::int32_t)> atom_name_;
  std::vector<std::uint32_t> uses_;     // by node
  std::vector<std::uint32_t> numbers_;  // by node; 0: not named
  std::vector<FormulaId> named_;        // by number - 1; positive
};

}  // namespace parallax::compiler
