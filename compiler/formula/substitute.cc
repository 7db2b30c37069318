#include "compiler/formula/substitute.h"

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

}  // namespace parallax::compiler
