#include "compiler/asp/completion_rules.h"

#include <algorithm>

#include "compiler/base/codes/grounding.h"

namespace parallax::compiler {
namespace {

/// Alternatives of one rule are doubled by each further occurrence; beyond this the general form
/// is shorter.
constexpr std::size_t kMaxOpenOccurrences = 4;

std::string tuple(const std::vector<std::string>& terms) {
  std::string text = "(";
  for (const auto& term : terms) text += term + ",";
  return text + ")";
}

bool mentions(const TypedModel& model, TypedFormulaId root, SymbolId predicate) {
  std::vector<TypedFormulaId> todo = {root};
  while (!todo.empty()) {
    const auto& formula = model.formulas[todo.back()];
    todo.pop_back();
    if (formula.kind == FormulaKind::kAtom && formula.predicate == predicate) return true;
    todo.insert(todo.end(), formula.children.begin(), formula.children.end());
  }
  return false;
}

bool is_occurrence(const AspLiteral& literal, SymbolId predicate) {
  return literal.predicate == predicate;
}

}  // namespace

CompletionRules::CompletionRules(const TypedModel& model, AspNames& names, TermWriter& terms,
                                 FormulaWriter& formulas, std::string& rules,
                                 base::DiagnosticSink& sink)
    : model_(model), terms_(terms), names_(names), formulas_(formulas), rules_(rules), sink_(sink) {
  for (const auto& completion : model.completions) {
    reasons_.push_back(names.fresh("reason_" + names.symbol(completion.predicate)));
    for (const auto& effect : model.effects) {
      effects_hide_completed_ =
          effects_hide_completed_ || mentions(model, effect.condition, completion.predicate);
    }
  }
}

/// Atoms in auxiliary rules, and in the conditions of effects, cannot be given their reasons.
bool CompletionRules::is_refused(const Axiom& axiom, const AspFormula& false_body) {
  if (!model_.options.founded) return false;
  const bool effects = axiom.mentions_effects && effects_hide_completed_;
  if (false_body.hidden.empty() && !effects) return false;
  sink_.error(codes::kAspNotFounded, axiom.source,
              effects ? std::string("a completed predicate in the condition of an effect")
                      : "`" + model_.symbols[*false_body.hidden.begin()].name + "`");
  return true;
}

/// The literal, and in a founded model the reasons of the completed atom that it asks for.
AspBody CompletionRules::with_reason(const AspLiteral& literal) const {
  AspBody body = {literal};
  if (!model_.options.founded || !literal.predicate || !literal.positive) return body;
  for (std::size_t c = 0; c < model_.completions.size(); ++c) {
    if (model_.completions[c].predicate != *literal.predicate) continue;
    body.push_back(plain_literal(applied(reasons_[c], literal.arguments)));
  }
  return body;
}

void CompletionRules::note(const Axiom& axiom, const std::vector<VariableId>& variables,
                           TypedFormulaId body, const AspFormula& false_body) {
  // A definition over effects (Clipped, ECCausal) gives no reason for the predicates that define
  // it.
  if (axiom.mentions_effects && model_.formulas[body].kind == FormulaKind::kIff) return;
  bool refused = false;
  for (std::size_t c = 0; c < model_.completions.size() && !refused; ++c) {
    const auto& completion = model_.completions[c];
    if (completion.label && *completion.label != axiom.label) continue;
    refused = is_refused(axiom, false_body);
    auto instance = terms_.domains(variables);
    append(instance, false_body.exists);
    bool hidden = false_body.hidden.contains(completion.predicate);
    for (const auto& alternative : false_body.alternatives) {
      const auto count = std::count_if(
          alternative.begin(), alternative.end(),
          [&](const AspLiteral& literal) { return is_occurrence(literal, completion.predicate); });
      hidden = hidden || count > static_cast<std::ptrdiff_t>(kMaxOpenOccurrences);
    }
    if (hidden) {
      hidden_reasons(c, instance, body);
      continue;
    }
    for (const auto& alternative : false_body.alternatives) {
      open_reasons(c, instance, alternative);
    }
  }
}

/// The instance is false if all of `body` holds. Without p it is so newly: p is one of the atoms
/// that `body` wants false, the others are false or the same atom, and those wanted true are
/// others.
void CompletionRules::open_reasons(std::size_t completion, const AspBody& instance,
                                   const AspBody& body) {
  const auto predicate = model_.completions[completion].predicate;
  for (std::size_t i = 0; i < body.size(); ++i) {
    if (!is_occurrence(body[i], predicate) || body[i].positive) continue;
    AspAlternatives ways = {instance};
    for (std::size_t k = 0; k < body.size(); ++k) {
      if (k == i) continue;
      const auto count = ways.size();
      const bool occurs = is_occurrence(body[k], predicate);
      const auto same =
          tuple(body[k].arguments) + (body[k].positive ? " != " : " = ") + tuple(body[i].arguments);
      for (std::size_t w = 0; w < count; ++w) {
        if (occurs && !body[k].positive) {
          ways.push_back(ways[w]);
          ways.back().push_back(plain_literal(same));
        }
        append(ways[w], with_reason(body[k]));
        if (occurs && body[k].positive) ways[w].push_back(plain_literal(same));
      }
    }
    for (const auto& way : ways) {
      rules_ += rule_text(applied(reasons_[completion], body[i].arguments), way);
    }
  }
}

AspPoint CompletionRules::point_of(SymbolId predicate) {
  const auto& symbol = model_.symbols[predicate];
  AspPoint point;
  point.predicate = predicate;
  bool unbounded = false;
  for (std::size_t i = 0; i < symbol.arguments.size(); ++i) {
    point.arguments.push_back(terms_.fresh_variable("P" + std::to_string(i + 1)));
    const bool moment = predicate == model_.core.happens && i == 1;
    const auto& sort = names_.sort(symbol.arguments[i]);
    point.domain.push_back(
        plain_literal(applied(moment ? "step" : sort, {point.arguments.back()})));
    unbounded = unbounded || terms_.is_unbounded(symbol.arguments[i]);
  }
  if (unbounded) {
    point.domain = {plain_literal(applied(formulas_.mentioned(predicate), point.arguments))};
  }
  return point;
}

void CompletionRules::hidden_reasons(std::size_t completion, const AspBody& instance,
                                     TypedFormulaId body) {
  const auto point = point_of(model_.completions[completion].predicate);
  const auto written = formulas_.write(body, false, &point);
  for (const auto& alternative : written.alternatives) {
    auto all = point.domain;
    append(all, instance);
    for (const auto& literal : alternative) append(all, with_reason(literal));
    rules_ += rule_text(applied(reasons_[completion], point.arguments), all);
  }
}

void CompletionRules::write() {
  for (std::size_t c = 0; c < model_.completions.size(); ++c) {
    const auto& completion = model_.completions[c];
    const auto arity = model_.symbols[completion.predicate].arguments.size();
    std::vector<std::string> variables;
    for (std::size_t i = 0; i < arity; ++i) variables.push_back("X" + std::to_string(i + 1));
    rules_ += "\n% completion " + (completion.label ? *completion.label + " " : "") +
              model_.symbols[completion.predicate].name + "\n" +
              rule_text("", {plain_literal(applied(names_.symbol(completion.predicate), variables)),
                             plain_literal("not " + applied(reasons_[c], variables))}) +
              "#defined " + reasons_[c] + "/" + std::to_string(arity) + ".\n";
  }
}

}  // namespace parallax::compiler
