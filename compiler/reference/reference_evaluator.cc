#include "compiler/reference/reference_evaluator.h"

#include <algorithm>
#include <cstdlib>

#include "compiler/base/contract.h"

namespace parallax::compiler {
namespace {

bool is_number(const std::string& text) {
  return !text.empty() &&
         text.find_first_not_of("0123456789", text[0] == '-' ? 1 : 0) == std::string::npos;
}

std::int64_t number(const std::string& text) { return std::strtoll(text.c_str(), nullptr, 10); }

}  // namespace

ReferenceEvaluator::ReferenceEvaluator(const TypedModel& model)
    : model_(model), domains_(reference_domains(model)) {
  fluent_sort_ = model.core.fluent->index();
  event_sort_ = model.core.event->index();
  horizon_ = static_cast<std::int64_t>(domains_.at(model.core.time->index()).size()) - 1;
  for (const auto& fluent : domains_.at(fluent_sort_)) {
    fluent_symbols_.emplace(fluent, *model.find_symbol(fluent.substr(0, fluent.find('('))));
  }
}

std::optional<Violation> ReferenceEvaluator::check(const Valuation& v) const {
  for (const auto& axiom : model_.axioms) {
    Environment environment;
    if (evaluate(axiom.formula, environment, v) == Truth::kFalse) {
      return Violation{axiom.source, "axiom", 0};
    }
  }
  return check_inertia(v);
}

bool ReferenceEvaluator::member(SortId sort, const std::string& value) const {
  const auto& domain = domains_.at(sort.index());
  if (domain.empty() && model_.sorts[sort].integer) return is_number(value);
  return std::find(domain.begin(), domain.end(), value) != domain.end();
}

std::optional<std::string> ReferenceEvaluator::term(TermId id,
                                                    const Environment& environment) const {
  const auto& node = model_.terms[id];
  std::vector<std::string> arguments;
  for (const auto argument : node.arguments) {
    const auto value = term(argument, environment);
    if (!value) return std::nullopt;
    arguments.push_back(*value);
  }
  switch (node.kind) {
    case TermKind::kVariable:
      return environment.at(node.variable.index());
    case TermKind::kObject:
      return model_.objects[node.object].name;
    case TermKind::kInteger:
      return std::to_string(node.integer);
    case TermKind::kArithmetic: {
      const auto a = number(arguments[0]);
      const auto b = number(arguments[1]);
      switch (node.op) {
        case ArithmeticOp::kAdd:
          return std::to_string(a + b);
        case ArithmeticOp::kSubtract:
          return std::to_string(a - b);
        case ArithmeticOp::kMultiply:
          return std::to_string(a * b);
        case ArithmeticOp::kDivide:
          return std::to_string(a / b);
        case ArithmeticOp::kModulo:
          return std::to_string(a % b);
      }
      return std::nullopt;
    }
    case TermKind::kApply: {
      const auto& symbol = model_.symbols[node.symbol];
      PARALLAX_REQUIRE(symbol.kind != SymbolKind::kFunction, "the oracle has no functions");
      std::string text = symbol.name + "(";
      for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (!member(symbol.arguments[i], arguments[i])) return std::nullopt;
        text += (i > 0 ? "," : "") + arguments[i];
      }
      return text + ")";
    }
  }
  return std::nullopt;
}

ReferenceEvaluator::Truth ReferenceEvaluator::atom(const TypedFormula& formula,
                                                   const Environment& environment,
                                                   const Valuation& v) const {
  const auto& symbol = model_.symbols[formula.predicate];
  std::vector<std::string> arguments;
  for (std::size_t i = 0; i < formula.terms.size(); ++i) {
    const auto value = term(formula.terms[i], environment);
    if (!value || !member(symbol.arguments[i], *value)) return Truth::kNothing;
    arguments.push_back(*value);
  }
  const auto truth = [](bool value) { return value ? Truth::kTrue : Truth::kFalse; };
  const auto at = [&] { return static_cast<std::size_t>(number(arguments[1])); };
  if (formula.predicate == model_.core.holds_at) {
    return truth(v.holds[at()].contains(arguments[0]));
  }
  if (formula.predicate == model_.core.released_at) {
    return truth(v.released[at()].contains(arguments[0]));
  }
  if (formula.predicate == model_.core.happens) {
    // Events at the last timepoint do not exist.
    if (number(arguments[1]) >= horizon_) {
      const bool named = model_.terms[formula.terms[1]].kind == TermKind::kInteger;
      return named ? Truth::kFalse : Truth::kNothing;
    }
    return truth(v.happens[at()].contains(arguments[0]));
  }
  std::string text = symbol.name + "(";
  for (std::size_t i = 0; i < arguments.size(); ++i) text += (i > 0 ? "," : "") + arguments[i];
  return truth(v.predicates.contains(text + ")"));
}

ReferenceEvaluator::Truth ReferenceEvaluator::quantified(const TypedFormula& formula,
                                                         std::size_t variable,
                                                         Environment& environment,
                                                         const Valuation& v) const {
  if (variable == formula.variables.size()) {
    return evaluate(formula.children[0], environment, v);
  }
  const bool universal = formula.kind == FormulaKind::kForall;
  const auto id = formula.variables[variable];
  bool any = false;
  bool decided = false;
  const auto& domain = domains_.at(model_.variables[id].sort.index());
  for (const auto& value : domain) {
    environment[id.index()] = value;
    const auto truth = quantified(formula, variable + 1, environment, v);
    any = any || truth != Truth::kNothing;
    decided = decided || truth == (universal ? Truth::kFalse : Truth::kTrue);
  }
  environment.erase(id.index());
  if (!any && !domain.empty()) return Truth::kNothing;
  return decided == universal ? Truth::kFalse : Truth::kTrue;
}

ReferenceEvaluator::Truth ReferenceEvaluator::evaluate(TypedFormulaId id, Environment& environment,
                                                       const Valuation& v) const {
  const auto& formula = model_.formulas[id];
  const auto child = [&](std::size_t i) { return evaluate(formula.children[i], environment, v); };
  const auto truth = [](bool value) { return value ? Truth::kTrue : Truth::kFalse; };
  switch (formula.kind) {
    case FormulaKind::kTrue:
      return Truth::kTrue;
    case FormulaKind::kFalse:
      return Truth::kFalse;
    case FormulaKind::kAtom:
      return atom(formula, environment, v);
    case FormulaKind::kForall:
    case FormulaKind::kExists:
      return quantified(formula, 0, environment, v);
    case FormulaKind::kCompare: {
      const auto a = term(formula.terms[0], environment);
      const auto b = term(formula.terms[1], environment);
      if (!a || !b) return Truth::kNothing;
      switch (formula.compare) {
        case CompareOp::kEqual:
          return truth(*a == *b);
        case CompareOp::kNotEqual:
          return truth(*a != *b);
        case CompareOp::kLess:
          return truth(number(*a) < number(*b));
        case CompareOp::kLessEqual:
          return truth(number(*a) <= number(*b));
        case CompareOp::kGreater:
          return truth(number(*a) > number(*b));
        case CompareOp::kGreaterEqual:
          return truth(number(*a) >= number(*b));
      }
      return Truth::kNothing;
    }
    case FormulaKind::kNot: {
      const auto value = child(0);
      return value == Truth::kNothing ? value : truth(value == Truth::kFalse);
    }
    case FormulaKind::kAnd:
    case FormulaKind::kOr: {
      const bool conjunction = formula.kind == FormulaKind::kAnd;
      bool nothing = false;
      for (std::size_t i = 0; i < formula.children.size(); ++i) {
        const auto value = child(i);
        if (value == truth(!conjunction)) return value;
        nothing = nothing || value == Truth::kNothing;
      }
      return nothing ? Truth::kNothing : truth(conjunction);
    }
    case FormulaKind::kImplies:
    case FormulaKind::kIff: {
      const auto a = child(0);
      const auto b = child(1);
      if (a == Truth::kNothing || b == Truth::kNothing) return Truth::kNothing;
      if (formula.kind == FormulaKind::kIff) return truth(a == b);
      return truth(a == Truth::kFalse || b == Truth::kTrue);
    }
  }
  return Truth::kNothing;
}

void ReferenceEvaluator::collect(const EffectAxiom& effect, std::size_t variable,
                                 Environment& environment, std::int64_t t, const Valuation& v,
                                 Effects& out) const {
  if (variable < effect.variables.size()) {
    const auto id = effect.variables[variable];
    for (const auto& value : domains_.at(model_.variables[id].sort.index())) {
      environment[id.index()] = value;
      collect(effect, variable + 1, environment, t, v, out);
    }
    environment.erase(id.index());
    return;
  }
  const auto event = term(effect.event, environment);
  const auto fluent = term(effect.fluent, environment);
  const auto time = term(effect.time, environment);
  if (!event || !fluent || !time || *time != std::to_string(t)) return;
  if (!v.happens[static_cast<std::size_t>(t)].contains(*event)) return;
  if (evaluate(effect.condition, environment, v) != Truth::kTrue) return;
  if (effect.kind == EffectKind::kInitiates) out.initiated.insert(*fluent);
  if (effect.kind == EffectKind::kTerminates) out.terminated.insert(*fluent);
  if (effect.kind == EffectKind::kReleases) out.released.insert(*fluent);
}

std::optional<Violation> ReferenceEvaluator::check_inertia(const Valuation& v) const {
  for (const auto& [fluent, symbol_id] : fluent_symbols_) {
    const auto& symbol = model_.symbols[symbol_id];
    for (std::int64_t t = 0; t <= horizon_; ++t) {
      const bool released = v.released[static_cast<std::size_t>(t)].contains(fluent);
      if (symbol.noninertial && !released) {
        return Violation{symbol.declared, "noninertial " + fluent, t};
      }
      if (t == 0 && released && !symbol.noninertial && !symbol.manual_release) {
        return Violation{symbol.declared, "released at the start: " + fluent, 0};
      }
    }
  }
  for (std::int64_t t = 0; t < horizon_; ++t) {
    Effects effects;
    for (const auto& effect : model_.effects) {
      Environment environment;
      collect(effect, 0, environment, t, v, effects);
    }
    for (const auto& [fluent, symbol] : fluent_symbols_) {
      if (auto violation = check_step(v, t, fluent, effects)) return violation;
    }
  }
  return std::nullopt;
}

std::optional<Violation> ReferenceEvaluator::check_step(const Valuation& v, std::int64_t t,
                                                        const std::string& fluent,
                                                        const Effects& effects) const {
  const auto now = static_cast<std::size_t>(t);
  const auto& symbol = model_.symbols[fluent_symbols_.at(fluent)];
  const bool before = v.holds[now].contains(fluent);
  const bool after = v.holds[now + 1].contains(fluent);
  const bool free_before = v.released[now].contains(fluent);
  const bool free_after = v.released[now + 1].contains(fluent);
  const bool up = effects.initiated.contains(fluent);
  const bool down = effects.terminated.contains(fluent);
  const bool freed = effects.released.contains(fluent);
  const auto wrong = [&](const char* name) {
    return Violation{symbol.declared, std::string(name) + " for " + fluent, t};
  };
  if (!symbol.noninertial) {
    if (before && !free_after && !down && !after) return wrong("DEC5");
    if (!before && !free_after && !up && after) return wrong("DEC6");
    if (free_before && !up && !down && !free_after) return wrong("DEC7");
    if (!free_before && !freed && free_after) return wrong("DEC8");
  }
  if (up && !after) return wrong("DEC9");
  if (down && after) return wrong("DEC10");
  if (freed && !free_after) return wrong("DEC11");
  if ((up || down) && free_after) return wrong("DEC12");
  return std::nullopt;
}

}  // namespace parallax::compiler
