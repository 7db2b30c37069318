#include "compiler/formula/atoms.h"

#include <algorithm>
#include <unordered_map>

namespace parallax::compiler {

std::vector<std::int32_t> atoms_of(const FormulaStore& store, std::span<const FormulaId> formulas) {
  std::vector<std::int32_t> found;
  std::vector<bool> seen(store.node_count(), false);
  std::vector<FormulaId> todo(formulas.begin(), formulas.end());
  while (!todo.empty()) {
    const auto id = todo.back();
    todo.pop_back();
    if (seen[id.node()]) continue;
    seen[id.node()] = true;
    if (store.kind(id) == FormulaNodeKind::kAtom) {
      found.push_back(store.variable(id));
    } else if (store.kind(id) == FormulaNodeKind::kAnd) {
      const auto children = store.children(id);
      todo.insert(todo.end(), children.begin(), children.end());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::int32_t> positive_atoms(const FormulaStore& store, FormulaId root) {
  std::vector<std::int32_t> found;
  std::unordered_map<std::uint32_t, bool> seen;  // by bits
  std::vector<FormulaId> todo = {root};
  while (!todo.empty()) {
    const auto id = todo.back();
    todo.pop_back();
    if (!seen.emplace(id.bits(), true).second) continue;
    if (store.kind(id) == FormulaNodeKind::kAtom) {
      if (!id.negated()) found.push_back(store.variable(id));
    } else if (store.kind(id) == FormulaNodeKind::kAnd) {
      for (const auto child : store.children(id)) {
        todo.push_back(id.negated() ? ~child : child);
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace parallax::compiler
