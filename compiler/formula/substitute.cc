#include "compiler/formula/substitute.h"

#include <algorithm>
#include <unordered_map>

namespace parallax::compiler {

FormulaId substitute(FormulaStore& store, FormulaId root, std::int32_t variable, bool value) {
  // By node, sign left out: what the positive node becomes.
  std::unordered_map<std::uint32_t, FormulaId> done;
  std::vector<std::uint32_t> todo = {root.node()};
  while (!todo.empty()) {
    const auto node = todo.back();
    const auto id = store.at(node);
    if (done.contains(node)) {
      todo.pop_back();
      continue;
    }
    if (store.kind(id) != FormulaNodeKind::kAnd) {
      const bool here = store.kind(id) == FormulaNodeKind::kAtom && store.variable(id) == variable;
      done.emplace(node, here ? store.constant(value) : id);
      todo.pop_back();
      continue;
    }
    bool ready = true;
    for (const auto child : store.children(id)) {
      if (done.contains(child.node())) continue;
      todo.push_back(child.node());
      ready = false;
    }
    if (!ready) continue;
    std::vector<FormulaId> parts;
    for (const auto child : store.children(id)) {
      const auto part = done.at(child.node());
      parts.push_back(child.negated() ? ~part : part);
    }
    done.emplace(node, store.conjunction(std::move(parts)));
    todo.pop_back();
  }
  const auto result = done.at(root.node());
  return root.negated() ? ~result : result;
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
