#include "compiler/repair/idle_condition.h"

#include <algorithm>
#include <string_view>

#include "compiler/syntax/printer.h"

namespace parallax::compiler {
namespace {

/// Does some event release the fluent? A variable in its place stands for all fluents.
bool is_released(const ModelAst& model, const std::vector<AxiomForm>& forms,
                 std::string_view fluent) {
  return std::any_of(forms.begin(), forms.end(), [&](const AxiomForm& form) {
    const auto& ast = model.ast(form.place);
    return std::any_of(form.effects.begin(), form.effects.end(), [&](NodeId effect) {
      if (ast.name(ast[effect]) != std::string_view("Releases")) return false;
      const auto& released = ast[effect_parts(ast, effect)->fluent];
      return released.kind != NodeKind::kApply || ast.name(released) == fluent;
    });
  });
}

}  // namespace

bool is_idle_condition(const ModelAst& model, const std::vector<AxiomForm>& forms,
                       const AxiomForm& axiom, const std::string& condition) {
  const auto& ast = model.ast(axiom.place);
  const auto opposite = condition.starts_with('!') ? condition.substr(1) : '!' + condition;
  for (const auto conjunct : axiom.conjuncts) {
    const auto text = print_formula(ast, conjunct);
    if (text == condition || text == opposite) return true;
  }
  if (axiom.effects.size() != 1) return false;
  const auto effect = axiom.effects.front();
  const auto fluent = effect_parts(ast, effect)->fluent;
  const auto holds = "HoldsAt(" + print_formula(ast, fluent) + ',' + axiom.time + ')';
  const std::string_view kind = ast.name(ast[effect]);
  const bool there = (kind == "Initiates" && condition == holds) ||
                     (kind == "Terminates" && condition == '!' + holds);
  return there && ast[fluent].kind == NodeKind::kApply &&
         !is_released(model, forms, ast.name(ast[fluent]));
}

}  // namespace parallax::compiler
