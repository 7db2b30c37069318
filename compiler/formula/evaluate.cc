#include "compiler/formula/evaluate.h"

#include <unordered_map>
#include <vector>

namespace parallax::compiler {
namespace {

Truth signed_value(Truth value, bool negated) {
  if (!negated || value == Truth::kUnknown) return value;
  return value == Truth::kTrue ? Truth::kFalse : Truth::kTrue;
}

}  // namespace

Truth evaluate(const FormulaStore& store, FormulaId root,
               const std::function<Truth(std::int32_t)>& atom) {
  std::unordered_map<std::uint32_t, Truth> done;  // by node
  std::vector<std::uint32_t> todo = {root.node()};
  while (!todo.empty()) {
    const auto id = store.at(todo.back());
    if (done.contains(id.node())) {
      todo.pop_back();
      continue;
    }
    if (store.kind(id) == FormulaNodeKind::kTrue) done.emplace(id.node(), Truth::kTrue);
    if (store.kind(id) == FormulaNodeKind::kAtom) done.emplace(id.node(), atom(store.variable(id)));
    if (store.kind(id) != FormulaNodeKind::kAnd) continue;
    bool ready = true;
    auto value = Truth::kTrue;
    for (const auto child : store.children(id)) {
      const auto found = done.find(child.node());
      if (found == done.end()) {
        ready = false;
        todo.push_back(child.node());
        continue;
      }
      const auto part = signed_value(found->second, child.negated());
      if (part == Truth::kFalse) value = Truth::kFalse;
      if (part == Truth::kUnknown && value == Truth::kTrue) value = Truth::kUnknown;
    }
    if (ready) done.emplace(id.node(), value);
  }
  return signed_value(done.at(root.node()), root.negated());
}

}  // namespace parallax::compiler
