#pragma once

#include <cstdint>
#include <vector>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Formulas without variables or quantifiers as plain trees. They are written down as they come;
/// only the constants `true` and `false` are worked out.
class FormulaTrees {
 public:
  using Node = std::uint32_t;

  FormulaTrees() : nodes_(2) { nodes_[kTruth].kind = FormulaKind::kTrue; }
  static constexpr Node kFalsity = 0, kTruth = 1;
  static Node constant(bool value) { return value ? kTruth : kFalsity; }

  Node atom(std::uint32_t number);
  /// kNot, kAnd, kOr, kImplies or kIff over its parts.
  Node connect(FormulaKind kind, const std::vector<Node>& parts);

  std::size_t size() const { return nodes_.size(); }
  /// Forgets the nodes made since there were `size` of them; nobody refers to them.
  void rewind(std::size_t size);

  /// The conjuncts of a conjunction, else the node itself.
  std::vector<Node> conjuncts(Node node) const;
  /// The atoms below a node, ascending, each once.
  std::vector<std::uint32_t> atoms_of(Node node) const;

  /// The truth value where values[a] tells whether atom a is true. As deep as the tree.
  bool value(Node node, const std::vector<std::uint8_t>& values) const;

 private:
  struct Entry {
    FormulaKind kind = FormulaKind::kFalse;
    std::uint32_t first = 0;  // the atom, or the place of the first part in parts_
    std::uint32_t count = 0;
  };
  Node add(FormulaKind kind, const std::vector<Node>& parts);
  Node junction(bool conjunction, const std::vector<Node>& parts);

  std::vector<Entry> nodes_;
  std::vector<Node> parts_;
};

}  // namespace parallax::compiler
