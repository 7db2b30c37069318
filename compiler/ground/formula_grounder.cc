#include "compiler/ground/formula_grounder.h"

#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/ground/grounding_frame.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

bool is_quantifier(FormulaKind kind) {
  return kind == FormulaKind::kForall || kind == FormulaKind::kExists;
}

bool is_leaf(FormulaKind kind) {
  return kind == FormulaKind::kTrue || kind == FormulaKind::kFalse || kind == FormulaKind::kAtom ||
         kind == FormulaKind::kCompare;
}

}  // namespace

FormulaGrounder::FormulaGrounder(GroundModel& model, const GroundOptions& options,
                                 base::DiagnosticSink& sink)
    : model_(&model),
      typed_(&model.typed()),
      terms_(model, options, sink),
      meaning_(options.meaning) {}

void FormulaGrounder::use_possible(PossibleAtoms* possible) {
  possible_ = possible;
  quantifiers_.clear();
}

std::optional<FormulaId> FormulaGrounder::ground(TypedFormulaId root) {
  std::vector<Frame> stack;
  std::optional<FormulaId> result;
  bool have_result = false;
  const auto push = [&](TypedFormulaId id) {
    const auto& formula = typed_->formulas[id];
    if (is_leaf(formula.kind)) {
      result = leaf(formula);
      have_result = true;
      return;
    }
    stack.emplace_back();
    stack.back().formula = &formula;
    have_result = false;
    if (is_quantifier(formula.kind)) begin_instances(stack.back(), id);
  };
  push(root);
  while (!stack.empty() && !failed()) {
    auto& frame = stack.back();
    const auto kind = frame.formula->kind;
    bool decided = false;
    if (have_result) {
      have_result = false;
      decided = take_part(frame, result);
      if (is_quantifier(kind)) {
        frame.exhausted = decided || !next_instance(frame);
      } else {
        ++frame.next_child;
      }
    }
    if (!decided && is_quantifier(kind) && !frame.exhausted) {
      push(frame.formula->children[0]);
    } else if (!decided && !is_quantifier(kind) &&
               frame.next_child < frame.formula->children.size()) {
      push(frame.formula->children[frame.next_child]);
    } else {
      result = combine(frame);
      have_result = true;
      for (const auto variable : frame.open) unbind(variable);
      stack.pop_back();
    }
  }
  if (failed()) {
    for (const auto& frame : stack) {
      for (const auto variable : frame.open) unbind(variable);
    }
    return std::nullopt;
  }
  return result;
}

/// Notes what a part or an instance has given. True: the rest cannot change the outcome.
bool FormulaGrounder::take_part(Frame& frame, std::optional<FormulaId> part) const {
  if (!part) {
    frame.discarded = true;
    return false;
  }
  frame.exists = true;
  if (frame.in_product) return true;
  frame.parts.push_back(*part);
  const auto kind = frame.formula->kind;
  const auto& formulas = model_->formulas();
  const bool both = is_quantifier(kind) || meaning_ == Meaning::kDecreasoner;
  return both && (((kind == FormulaKind::kAnd || kind == FormulaKind::kForall) &&
                   *part == formulas.falsity()) ||
                  ((kind == FormulaKind::kOr || kind == FormulaKind::kExists) &&
                   *part == formulas.truth()));
}

std::optional<FormulaId> FormulaGrounder::combine(Frame& frame) {
  auto& formulas = model_->formulas();
  auto& parts = frame.parts;
  const bool all_there = !frame.discarded;
  switch (frame.formula->kind) {
    case FormulaKind::kAnd: {
      if (!all_there && meaning_ == Meaning::kStandard) return std::nullopt;
      const auto value = formulas.conjunction(std::move(parts));
      if (all_there || value == formulas.falsity()) return value;
      return std::nullopt;
    }
    case FormulaKind::kOr: {
      if (!all_there && meaning_ == Meaning::kStandard) return std::nullopt;
      const auto value = formulas.disjunction(std::move(parts));
      if (all_there || value == formulas.truth()) return value;
      return std::nullopt;
    }
    case FormulaKind::kForall:
    case FormulaKind::kExists: {
      if (frame.discarded && !frame.exists && meaning_ == Meaning::kStandard) return std::nullopt;
      return frame.formula->kind == FormulaKind::kForall ? formulas.conjunction(std::move(parts))
                                                         : formulas.disjunction(std::move(parts));
    }
    case FormulaKind::kNot:
      if (!all_there) return std::nullopt;
      return ~parts[0];
    case FormulaKind::kImplies:
      if (!all_there) return std::nullopt;
      return formulas.implication(parts[0], parts[1]);
    case FormulaKind::kIff:
      if (!all_there) return std::nullopt;
      return formulas.equivalence(parts[0], parts[1]);
    case FormulaKind::kTrue:
    case FormulaKind::kFalse:
    case FormulaKind::kAtom:
    case FormulaKind::kCompare:
      break;
  }
  PARALLAX_REQUIRE(false, "a frame is a connective or a quantifier");
  return std::nullopt;
}

std::optional<FormulaId> FormulaGrounder::leaf(const TypedFormula& formula) {
  if (formula.kind == FormulaKind::kTrue) return model_->formulas().truth();
  if (formula.kind == FormulaKind::kFalse) return model_->formulas().falsity();
  if (formula.kind == FormulaKind::kAtom) return atom(formula);
  const auto value = terms_.compare(formula);
  if (!value) return std::nullopt;
  return model_->formulas().constant(*value);
}

std::optional<FormulaId> FormulaGrounder::atom(const TypedFormula& formula) {
  std::vector<GroundTermId> arguments;
  for (const auto id : formula.terms) {
    const auto value = term(id);
    if (!value) return std::nullopt;
    arguments.push_back(*value);
  }
  const auto& symbol = typed_->symbols[formula.predicate];
  if (!terms_.arguments_fit(symbol, arguments)) return std::nullopt;
  const auto& core = typed_->core;
  const auto& terms = model_->terms();
  const bool is_holds = formula.predicate == core.holds_at;
  if (is_holds || formula.predicate == core.released_at) {
    const auto number = model_->fluent_number(arguments[0]);
    if (!number) return std::nullopt;
    const auto t = static_cast<Timepoint>(terms[arguments[1]].integer);
    return is_holds ? model_->holds(*number, t) : model_->released(*number, t);
  }
  if (formula.predicate == core.happens) {
    const auto number = model_->event_number(arguments[0]);
    const auto t = static_cast<Timepoint>(terms[arguments[1]].integer);
    if (!number) return std::nullopt;
    if (t < model_->horizon()) return model_->happens(*number, t);
    // Said of the last timepoint itself, an event does not happen there; reached by a variable, the
    // instance is beyond the horizon.
    const bool named = typed_->terms[formula.terms[1]].kind == TermKind::kInteger;
    if (named) return model_->formulas().falsity();
    return std::nullopt;
  }
  if (formula.predicate == core.initiates) return effect_atom(EffectKind::kInitiates, arguments);
  if (formula.predicate == core.terminates) return effect_atom(EffectKind::kTerminates, arguments);
  if (formula.predicate == core.releases) return effect_atom(EffectKind::kReleases, arguments);
  return model_->predicate(model_->terms().apply(formula.predicate, arguments));
}

/// Like the events they speak of, effects exist before the last timepoint only.
std::optional<FormulaId> FormulaGrounder::effect_atom(EffectKind kind,
                                                      const std::vector<GroundTermId>& arguments) {
  const auto event = model_->event_number(arguments[0]);
  const auto fluent = model_->fluent_number(arguments[1]);
  const auto t = static_cast<Timepoint>(model_->terms()[arguments[2]].integer);
  if (!event || !fluent || t >= model_->horizon() || rows_ == nullptr) return std::nullopt;
  return rows_->holds(kind, *event, *fluent, t, *model_);
}

}  // namespace parallax::compiler
