#include "compiler/formula/formula_text.h"

#include <utility>

namespace parallax::compiler {

FormulaText::FormulaText(const FormulaStore& store,
                         std::function<std::string(std::int32_t)> atom_name)
    : store_(store), atom_name_(std::move(atom_name)) {}

void FormulaText::know_nodes() {
  uses_.resize(store_.node_count(), 0);
  numbers_.resize(store_.node_count(), 0);
}

void FormulaText::count(FormulaId formula) {
  know_nodes();
  std::vector<FormulaId> todo = {formula};
  while (!todo.empty()) {
    const auto id = todo.back();
    todo.pop_back();
    if (++uses_[id.node()] > 1 || store_.kind(id) != FormulaNodeKind::kAnd) continue;
    const auto children = store_.children(id);
    todo.insert(todo.end(), children.begin(), children.end());
  }
}

std::string FormulaText::part_name(FormulaId id) {
  auto& number = numbers_[id.node()];
  if (number == 0) {
    named_.push_back(id.negated() ? ~id : id);
    number = static_cast<std::uint32_t>(named_.size());
  }
  return (id.negated() ? "!#" : "#") + std::to_string(number);
}

std::string FormulaText::text(FormulaId formula) {
  know_nodes();
  struct Piece {
    FormulaId id;
    const char* fixed = nullptr;  // instead of a formula
  };
  std::string out;
  std::vector<Piece> todo = {{formula}};
  bool outermost = true;
  while (!todo.empty()) {
    const auto [id, fixed] = todo.back();
    todo.pop_back();
    const bool whole = std::exchange(outermost, false);
    if (fixed != nullptr) {
      out += fixed;
    } else if (store_.kind(id) == FormulaNodeKind::kTrue) {
      out += id.negated() ? "false" : "true";
    } else if (store_.kind(id) == FormulaNodeKind::kAtom) {
      out += (id.negated() ? "!" : "") + atom_name_(store_.variable(id));
    } else if (!whole && uses_[id.node()] > 1) {
      out += part_name(id);
    } else {
      const auto children = store_.children(id);
      if (!whole) todo.push_back({{}, ")"});
      for (std::size_t i = children.size(); i-- > 0;) {
        todo.push_back({id.negated() ? ~children[i] : children[i]});
        if (i > 0) todo.push_back({{}, id.negated() ? " | " : " & "});
      }
      if (!whole) todo.push_back({{}, "("});
    }
  }
  return out;
}

std::string FormulaText::definitions() {
  std::string out;
  // The list grows with the parts that the definitions name.
  for (std::size_t i = 0; i < named_.size(); ++i) {
    out += "#" + std::to_string(i + 1) + " = " + text(named_[i]) + '\n';
  }
  return out;
}

}  // namespace parallax::compiler
