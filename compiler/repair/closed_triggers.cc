#include "compiler/repair/closed_triggers.h"

#include <map>

#include "compiler/repair/condition_literal.h"
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

/// "({floor} floor9000=floor & HoldsAt(Called(floor),time))".
std::string reason(const Ast& ast, const AxiomForm& form, const std::vector<std::string>& names) {
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
  return "(" + quantifier + joined(parts, " & ") + ")";
}

}  // namespace

std::string closed_triggers(const ModelAst& model, const TypedModel& typed,
                            const std::vector<AxiomForm>& forms,
                            const std::set<std::string>& performed) {
  std::map<std::string, std::vector<std::string>> reasons;
  for (const auto& form : forms) {
    if (form.kind != AxiomForm::Kind::kTrigger || performed.contains(form.event_symbol)) continue;
    const auto symbol = typed.find_symbol(form.event_symbol);
    const auto& ast = model.ast(form.place);
    if (!symbol || typed.symbols[*symbol].arguments.size() != ast[form.event].child_count)
      return {};
    const auto names = own_variables(typed, typed.symbols[*symbol].arguments);
    auto text = reason(ast, form, names);
    if (form.time != "time") return {};  // the sentences share one name
    reasons[form.event_symbol].push_back(std::move(text));
  }
  std::string out;
  for (const auto& [event, whys] : reasons) {
    auto names = own_variables(typed, typed.symbols[*typed.find_symbol(event)].arguments);
    const auto happens = "Happens(" + event + "(" + joined(names, ",") + "),time)";
    names.emplace_back("time");
    out += "[" + joined(names, ",") + "] " + happens + " -> " + joined(whys, " | ") + ".\n";
  }
  return out;
}

}  // namespace parallax::compiler
