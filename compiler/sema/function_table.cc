#include "compiler/sema/function_table.h"

#include <algorithm>
#include <vector>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/sema/name_advice.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

std::string printed(const TypedModel& model, TermId term) {
  const Term& value = model.terms[term];
  if (value.kind == TermKind::kInteger) return std::to_string(value.integer);
  if (value.kind == TermKind::kObject) return model.objects[value.object].name;
  return value.kind == TermKind::kApply ? model.symbols[value.symbol].name + "(...)" : "?";
}

}  // namespace

bool FunctionTable::is_value(TermId root) const {
  std::vector<TermId> visit = {root};
  while (!visit.empty()) {
    const Term& term = model_.terms[visit.back()];
    visit.pop_back();
    if (term.kind == TermKind::kVariable || term.kind == TermKind::kArithmetic) return false;
    if (term.kind != TermKind::kApply) continue;
    if (model_.symbols[term.symbol].kind == SymbolKind::kFunction) return false;
    visit.insert(visit.end(), term.arguments.begin(), term.arguments.end());
  }
  return true;
}

void FunctionTable::append_key(TermId root, std::string& key) const {
  std::vector<TermId> visit = {root};
  while (!visit.empty()) {
    const Term& term = model_.terms[visit.back()];
    visit.pop_back();
    if (term.kind == TermKind::kObject) {
      key += 'o' + std::to_string(term.object.index());
    } else if (term.kind == TermKind::kInteger) {
      key += 'i' + std::to_string(term.integer);
    } else {  // the number of arguments is fixed, so no bracket is needed
      key += 'a' + std::to_string(term.symbol.index());
      visit.insert(visit.end(), term.arguments.rbegin(), term.arguments.rend());
    }
  }
}

bool FunctionTable::lies_in(TermId value, SortId sort, SortDomains& domains) const {
  const Term& term = model_.terms[value];
  if (term.kind == TermKind::kInteger) {
    return model_.sorts[sort].integer && domains.contains(sort, term.integer);
  }
  if (term.kind == TermKind::kObject) {
    const auto& sorts = model_.objects[term.object].sorts;
    return std::any_of(sorts.begin(), sorts.end(),
                       [&](SortId own) { return model_.is_subsort(own, sort); });
  }
  const auto& result = model_.symbols[term.symbol].result;
  return result && model_.is_subsort(*result, sort);
}

bool FunctionTable::add(TypedFormulaId id, SortDomains& domains) {
  const TypedFormula& formula = model_.formulas[id];
  if (formula.kind != FormulaKind::kCompare || formula.compare != CompareOp::kEqual) return false;
  const Term& left = model_.terms[formula.terms[0]];
  const TermId value = formula.terms[1];
  if (left.kind != TermKind::kApply || model_.symbols[left.symbol].kind != SymbolKind::kFunction ||
      !is_value(value) ||
      !std::all_of(left.arguments.begin(), left.arguments.end(),
                   [this](TermId argument) { return is_value(argument); })) {
    return false;
  }
  const Symbol& function = model_.symbols[left.symbol];
  if (!lies_in(value, *function.result, domains)) {
    sink_
        .warning(DiagnosticCode::kFunctionValueOutsideSort, model_.terms[value].source,
                 printed(model_, value), model_.sorts[*function.result].name)
        .note(function.declared, "`" + signature(model_, function) + "` declared here");
  }
  std::string key;
  append_key(formula.terms[0], key);
  const auto [entry, is_new] = entries_.emplace(key, model_.function_values.size());
  if (is_new) {
    model_.function_values.push_back({left.symbol, left.arguments, value, formula.source});
    return true;
  }
  const auto& before = model_.function_values[entry->second];
  std::string old_value, new_value;
  append_key(before.value, old_value);
  append_key(value, new_value);
  if (old_value != new_value) {
    sink_.error(DiagnosticCode::kFunctionValueTwice, formula.source, function.name)
        .note(before.source, "the other value is given here");
  }
  return true;
}

}  // namespace parallax::compiler
