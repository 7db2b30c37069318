#include "compiler/repair/edit_grammar.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>
#include <vector>

#include "compiler/base/ground_name.h"
#include "compiler/repair/edit_subject.h"
#include "compiler/repair/effect_bundle.h"
#include "compiler/syntax/printer.h"

namespace parallax::compiler {
namespace {

constexpr int kDelayOddity = 2;
constexpr std::size_t kLatest = 3;  // steps

bool is_of_a_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The formula at another time: wherever the variable stands by itself, it is `earlier`.
std::string at_time(const std::string& formula, const std::string& time,
                    const std::string& earlier) {
  std::string out;
  for (std::size_t i = 0; i < formula.size();) {
    if (!is_of_a_name(formula[i])) {
      out += formula[i++];
      continue;
    }
    auto end = i;
    while (end < formula.size() && is_of_a_name(formula[end])) ++end;
    const auto word = formula.substr(i, end - i);
    out += word == time ? earlier : word;
    i = end;
  }
  return out;
}

/// Variables for the arguments of an event, under names that are not in `taken`.
std::vector<std::string> fresh_variables(const TypedModel& typed, const std::vector<SortId>& sorts,
                                         std::vector<std::string> taken) {
  std::vector<std::string> out;
  for (const auto sort : sorts) {
    const auto& name = typed.sorts[sort].name;
    auto variable = name;
    for (int n = 1; std::find(taken.begin(), taken.end(), variable) != taken.end(); ++n) {
      variable = name + std::to_string(n);
    }
    taken.push_back(variable);
    out.push_back(std::move(variable));
  }
  return out;
}

Edit::Sentence sentence(const Ast& ast, const AxiomForm& form, const TypedModel& typed,
                        const Symbol& next, std::size_t by) {
  const auto earlier = form.time + "-" + std::to_string(by);
  Edit::Sentence out;
  for (const auto& variable : form.variables) {
    if (variable != form.time) out.variables.push_back(variable);
  }
  const auto own = fresh_variables(typed, next.arguments, form.variables);
  out.variables.insert(out.variables.end(), own.begin(), own.end());
  out.variables.push_back(form.time);
  out.condition = "Happens(" + print_formula(ast, form.event) + "," + earlier + ")";
  for (const auto conjunct : form.conjuncts) {
    const auto kind = ast[conjunct].kind;
    const bool alone = kind == NodeKind::kApply || kind == NodeKind::kUnary;
    const auto text = at_time(print_formula(ast, conjunct), form.time, earlier);
    out.condition += " & " + (alone ? text : "(" + text + ")");
  }
  const auto effect = form.effects.front();
  const auto parts = *effect_parts(ast, effect);
  std::string happening = next.name + "(";
  for (std::size_t i = 0; i < own.size(); ++i) happening += (i == 0 ? "" : ",") + own[i];
  out.effect = std::string(ast.name(ast[effect])) + "(" + happening + ")," +
               print_formula(ast, parts.fluent) + "," + form.time + ")";
  return out;
}

/// Effects that came later than the model says (EditScope::Late): instead of
/// `condition -> Initiates(E,F,time)` what happens k steps behind E has the effect,
/// `Happens(E,time-k) & condition at time-k -> Initiates(E2,F,time)`, a sentence for each event E2
/// that was seen there. Of axioms with one effect. Appends to `edits`.
void add_delays(const ModelAst& model, const TypedModel& typed, const std::vector<AxiomForm>& forms,
                const EditScope& scope, std::vector<Edit>& edits) {
  struct Case {
    std::string event, fluent;
    std::size_t by = 0;
    auto operator<=>(const Case&) const = default;
  };
  std::map<Case, std::set<std::string>> next_of;
  for (const auto& step : scope.steps) {
    for (const auto& late : step.late) {
      for (const auto& fluent : late.fluents) {
        next_of[{base::symbol_of(step.event), base::symbol_of(fluent), late.by}].insert(
            base::symbol_of(late.event));
      }
    }
  }
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const auto& form = forms[i];
    if (form.kind != AxiomForm::Kind::kEffects || form.effects.size() != 1) continue;
    const auto& ast = model.ast(form.place);
    const auto& fluent = ast[effect_parts(ast, form.effects.front())->fluent];
    if (fluent.kind != NodeKind::kApply) continue;
    for (const auto& [late, events] : next_of) {
      if (late.event != form.event_symbol || late.fluent != ast.name(fluent)) continue;
      Edit edit;
      edit.kind = Edit::Kind::kDelay;
      edit.axioms = {i};
      edit.event = form.event_symbol;
      edit.oddity = kDelayOddity + static_cast<int>(late.by - 1);
      for (const auto& event : events) {
        const auto symbol = typed.find_symbol(event);
        if (!symbol || typed.symbols[*symbol].kind != SymbolKind::kEvent) continue;
        edit.sentences.push_back(sentence(ast, form, typed, typed.symbols[*symbol], late.by));
      }
      if (!edit.sentences.empty()) edits.push_back(std::move(edit));
    }
  }
}

/// Effects that the model says to come late: `Happens(E,time-k) & condition ->
/// Initiates(E2,F,time)` becomes `condition -> Initiates(E,F,time)`. Appends to `edits`.
void add_hastes(const EditSubject& subject, std::vector<Edit>& edits) {
  for (std::size_t i = 0; i < subject.forms.size(); ++i) {
    const auto& form = subject.forms[i];
    if (form.kind != AxiomForm::Kind::kLateEffects || !subject.events.contains(form.event_symbol)) {
      continue;
    }
    const auto& ast = subject.model.ast(form.place);
    const auto parts = effect_parts(ast, form.effects.front());
    const auto event = print_formula(ast, form.event);
    Edit edit;
    edit.kind = Edit::Kind::kDelay;
    edit.axioms = {i};
    edit.event = form.event_symbol;
    edit.oddity = kDelayOddity;
    edit.words = "comes at once";
    Edit::Sentence now;
    std::string gone;  // the variable of the event that comes later
    if (ast[parts->event].kind == NodeKind::kName) gone = ast.name(ast[parts->event]);
    for (const auto& variable : form.variables) {
      if (variable != gone) now.variables.push_back(variable);
    }
    for (const auto conjunct : form.conjuncts) {
      const auto& node = ast[conjunct];
      if (node.kind == NodeKind::kApply && ast.name(node) == "Happens") continue;
      auto text = print_formula(ast, conjunct);
      if (node.kind != NodeKind::kApply && node.kind != NodeKind::kUnary) text = "(" + text + ")";
      for (std::size_t k = 1; k <= kLatest; ++k) {
        const auto earlier = form.time + "-" + std::to_string(k);
        for (auto at = text.find(earlier); at != std::string::npos; at = text.find(earlier)) {
          text.replace(at, earlier.size(), form.time);
        }
      }
      now.condition += (now.condition.empty() ? "" : " & ") + text;
    }
    for (const auto effect : form.effects) {
      const auto each = effect_parts(ast, effect);
      now.effect += (now.effect.empty() ? "" : " & ") + std::string(ast.name(ast[effect])) + "(" +
                    event + "," + print_formula(ast, each->fluent) + "," + form.time + ")";
    }
    edit.sentences.push_back(std::move(now));
    edits.push_back(std::move(edit));
  }
}

EditSubject subject_of(const ModelAst& model, const TypedModel& typed,
                       const std::vector<AxiomForm>& forms, const EditScope& scope) {
  EditSubject out{model,
                  typed,
                  forms,
                  scope,
                  EditRelevance(model, forms, scope),
                  scope.more_events,
                  scope.more_fluents};
  for (const auto& step : scope.steps) {
    out.events.insert(base::symbol_of(step.event));
    for (const auto& [fluent, holds] : step.differing) out.fluents.insert(base::symbol_of(fluent));
  }
  return out;
}

}  // namespace

std::vector<std::string> arguments_of(const std::string& ground) {
  std::vector<std::string> out;
  const auto open = ground.find('(');
  if (open == std::string::npos || open + 2 >= ground.size()) return out;
  int depth = 0;
  std::string current;
  for (std::size_t i = open + 1; i + 1 < ground.size(); ++i) {
    const char c = ground[i];
    if (c == '(') ++depth;
    if (c == ')') --depth;
    if (c == ',' && depth == 0) {
      out.push_back(std::move(current));
      current.clear();
    } else {
      current += c;
    }
  }
  out.push_back(std::move(current));
  return out;
}

std::vector<Edit> edits_in_scope(const ModelAst& model, const TypedModel& typed,
                                 const std::vector<AxiomForm>& forms, const EditScope& scope) {
  const auto subject = subject_of(model, typed, forms, scope);
  std::vector<Edit> out;
  if (scope.alternatives) {
    add_alternatives(subject, out);
    return out;
  }
  add_axiom_edits(subject, out);
  add_event_edits(subject, out);
  add_triggers(subject, out);
  add_state_edits(subject, out);
  add_counter_effects(subject, out);
  add_hastes(subject, out);
  add_delays(model, typed, forms, scope, out);
  add_effect_bundles(model, typed, forms, scope, out);
  return out;
}

std::vector<Edit> start_edits(const ModelAst& model, const TypedModel& typed,
                              const std::vector<AxiomForm>& forms, const EditScope& scope) {
  const auto subject = subject_of(model, typed, forms, scope);
  std::vector<Edit> out;
  add_start_edits(subject, out);
  add_state_edits(subject, out);
  add_start_facts(subject, out);
  add_missing_definitions(subject, out);
  return out;
}

}  // namespace parallax::compiler
