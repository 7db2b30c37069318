#include "compiler/formula/substitute.h"

#include <vector>

namespace parallax::compiler {

FormulaId rewrite_atoms(FormulaStore& store, FormulaId root,
                        const std::function<FormulaId(std::int32_t)>& atom, RewriteMemo& memo) {
  std::vector<std::uint32_t> todo = {root.node()};
  while (!todo.empty()) {
    const auto node = todo.back();
    const auto id = store.at(node);
    if (memo.contains(node)) {
      todo.pop_back();
      continue;
    }
    if (store.kind(id) != FormulaNodeKind::kAnd) {
      const bool is_atom = store.kind(id) == FormulaNodeKind::kAtom;
      memo.emplace(node, is_atom ? atom(store.variable(id)) : id);
      todo.pop_back();
      continue;
    }
    bool ready = true;
    for (const auto child : store.children(id)) {
      if (memo.contains(child.node())) continue;
      todo.push_back(child.node());
      ready = false;
    }
    if (!ready) continue;
    std::vector<FormulaId> parts;
    for (const auto child : store.children(id)) {
      const auto part = memo.at(child.node());
      parts.push_back(child.negated() ? ~part : part);
    }
    memo.emplace(node, store.conjunction(std::move(parts)));
    todo.pop_back();
  }
  const auto result = memo.at(root.node());
  return root.negated() ? ~result : result;
}

FormulaId substitute(FormulaStore& store, FormulaId root, std::int32_t variable, bool value) {
  RewriteMemo memo;
  return rewrite_atoms(
      store, root,
      [&](std::int32_t v) { return v == variable ? store.constant(value) : store.atom(v); }, memo);
}

}  // namespace parallax::compiler
