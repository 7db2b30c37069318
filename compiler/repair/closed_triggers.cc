#include "compiler/repair/closed_triggers.h"

#include <map>
#include <set>

#include "compiler/repair/condition_literal.h"
#include "compiler/repair/number_term.h"
#include "compiler/syntax/printer.h"

namespace parallax::compiler {
namespace {

std::string joined(const std::vector<std::string>& parts, const char* between) {
  std::string out;
  for (const auto& part : parts) out += (out.empty() ? "" : between) + part;
  return out;
}

/// Variables for the arguments of an event, under names that no axiom uses.
std::vector<std::string> own_variables(const TypedModel& typed, const std::vector<SortId>& sorts) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < sorts.size(); ++i) {
    out.push_back(typed.sorts[sorts[i]].name + std::to_string(9000 + i));
  }
  return out;
}

/// The variable for the time of all sentences; likewise.
std::string own_time(const TypedModel& typed) {
  return typed.core.time ? typed.sorts[*typed.core.time].name + "8999" : std::string();
}

/// Symbols of events that a formula, taken to be true, can demand.
class Demands {
 public:
  explicit Demands(const Ast& ast) : ast_(ast) {}

  void collect(NodeId at, bool positive) {
    const auto& node = ast_[at];
    if (node.kind == NodeKind::kApply) {
      if (ast_.name(node) != "Happens" || !positive || node.child_count == 0) return;
      const auto& event = ast_[ast_.child(node, 0)];
      any = any || event.kind != NodeKind::kApply;
      symbols.insert(std::string(ast_.name(event)));
      return;
    }
    const bool either =
        node.kind == NodeKind::kBinary && (node.op == Operator::kIff || is_comparison(node.op));
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      const bool turned =
          (node.kind == NodeKind::kUnary && node.op == Operator::kNot) ||
          (node.kind == NodeKind::kBinary && node.op == Operator::kImplies && i == 0);
      collect(ast_.child(node, i), positive != turned);
      if (either) collect(ast_.child(node, i), positive == turned);
    }
  }

  std::set<std::string> symbols;
  bool any = false;  // a variable stands for the event

 private:
  const Ast& ast_;
};

/// "({floor} floor9000=floor & HoldsAt(Called(floor),time8999))". Empty: the time is not any.
std::string reason(const Ast& ast, const TypedModel& typed, const AxiomForm& form,
                   const std::vector<std::string>& names) {
  const auto time = sort_of_variable(typed, form.time);
  if (!time || time != typed.core.time) return {};
  std::vector<std::string> some, parts;
  for (const auto& variable : form.variables) {
    if (variable != form.time) some.push_back(variable);
  }
  const auto& event = ast[form.event];
  for (std::uint32_t i = 0; i < event.child_count; ++i) {
    parts.push_back(names[i] + "=" + print_formula(ast, ast.child(event, i)));
  }
  parts.push_back("(" + print_formula(ast, *form.condition) + ")");
  const auto quantifier = some.empty() ? "" : "{" + joined(some, ",") + "} ";
  return with_names("(" + quantifier + joined(parts, " & ") + ")", {{form.time, own_time(typed)}});
}

}  // namespace

std::string performed_fluent(std::string_view symbol) {
  return "Performed9000" + std::string(symbol) + "()";
}

ClosedTriggers closed_triggers(const ModelAst& model, const base::SourceFiles& files,
                               const TypedModel& typed) {
  std::map<std::string, std::vector<std::string>> reasons;
  std::set<std::string> open;
  for (const auto& form : all_forms(model, files)) {
    const auto& ast = model.ast(form.place);
    // Effect axioms demand no event.
    if (form.kind == AxiomForm::Kind::kEffects || form.kind == AxiomForm::Kind::kLateEffects ||
        form.kind == AxiomForm::Kind::kRamification) {
      continue;
    }
    const bool trigger = form.kind == AxiomForm::Kind::kTrigger;
    Demands demands(ast);
    trigger ? demands.collect(*form.condition, false) : demands.collect(form.body, true);
    if (demands.any) return {};
    open.merge(demands.symbols);
    if (!trigger) continue;
    const auto symbol = typed.find_symbol(form.event_symbol);
    auto text = std::string();
    if (symbol && typed.symbols[*symbol].arguments.size() == ast[form.event].child_count) {
      text = reason(ast, typed, form, own_variables(typed, typed.symbols[*symbol].arguments));
    }
    if (text.empty()) open.insert(form.event_symbol);
    reasons[form.event_symbol].push_back(std::move(text));
  }
  ClosedTriggers out;
  const auto time = own_time(typed);
  for (auto& [event, whys] : reasons) {
    if (open.contains(event)) continue;
    auto names = own_variables(typed, typed.symbols[*typed.find_symbol(event)].arguments);
    const auto happens = "Happens(" + event + "(" + joined(names, ",") + ")," + time + ")";
    names.push_back(time);
    const auto fluent = performed_fluent(event);
    const auto name = fluent.substr(0, fluent.find('('));
    out.text += "fluent " + fluent + "\nnoninertial " + name + "\n";
    whys.push_back("HoldsAt(" + fluent + "," + time + ")");
    out.text += "[" + joined(names, ",") + "] " + happens + " -> " + joined(whys, " | ") + ".\n";
    out.symbols.push_back(event);
  }
  return out;
}

}  // namespace parallax::compiler
