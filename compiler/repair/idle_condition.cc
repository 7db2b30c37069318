#include "compiler/repair/idle_condition.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/repair/condition_literal.h"
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

/// "!A" for "A" and the other way round, "x!=y" for "x=y", "x>=y" for "x<y".
std::string opposite_of(const std::string& condition) {
  constexpr std::pair<std::string_view, std::string_view> kRelations[] = {
      {"!=", "="}, {">=", "<"}, {"<", ">="}, {"=", "!="}};
  if (condition.starts_with('!')) return condition.substr(1);
  for (const auto& [sign, other] : kRelations) {
    const auto at = condition.find(sign);
    if (condition.ends_with(')') || at == std::string::npos) continue;
    return condition.substr(0, at) + std::string(other) + condition.substr(at + sign.size());
  }
  return '!' + condition;
}

/// Is `condition` that there is one of what `text` names, as `HoldsAt(F(a),time)` does for
/// `({x} HoldsAt(F(x),time))`?
bool implies_some(const std::string& text, const std::string& condition) {
  if (!condition.starts_with("({")) return false;
  const auto close = condition.find("} ");
  if (close == std::string::npos) return false;
  std::vector<std::string> open;
  for (std::size_t at = 2; at < close;) {
    const auto end = std::min(condition.find(',', at), close);
    open.push_back(condition.substr(at, end - at));
    at = end + 1;
  }
  const auto inner = condition.substr(close + 2, condition.size() - close - 3);
  // The places of the quantified variables are open.
  std::string pattern;
  for (std::size_t i = 0; i < inner.size();) {
    auto end = i;
    while (end < inner.size() && inner[end] != '(' && inner[end] != ')' && inner[end] != ',') ++end;
    const auto word = inner.substr(i, end - i);
    pattern += std::find(open.begin(), open.end(), word) == open.end() ? word : "*";
    if (end < inner.size()) pattern += inner[end++];
    i = end;
  }
  return matches(text, pattern);
}

}  // namespace

bool is_idle_condition(const ModelAst& model, const std::vector<AxiomForm>& forms,
                       const AxiomForm& axiom, const std::string& condition) {
  const auto& ast = model.ast(axiom.place);
  const auto opposite = opposite_of(condition);
  for (const auto conjunct : axiom.conjuncts) {
    const auto text = print_formula(ast, conjunct);
    if (text == condition || text == opposite || implies_some(text, condition) ||
        implies_some(text, opposite)) {
      return true;
    }
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
