#include "compiler/ground/formula_grounder.h"

#include <limits>
#include <utility>

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

/// One formula under expansion: what its parts (or instances) have given so far.
struct FormulaGrounder::Frame {
  const TypedFormula* formula = nullptr;
  std::size_t next_child = 0;
  std::vector<FormulaId> parts;
  bool discarded = false;             // some part named nothing that exists
  std::vector<std::size_t> odometer;  // quantifiers: the current instance
  bool exhausted = false;
};

FormulaGrounder::FormulaGrounder(GroundModel& model, const GroundOptions& options,
                                 base::DiagnosticSink& sink)
    : model_(&model),
      typed_(&model.typed()),
      options_(options),
      sink_(&sink),
      environment_(model.typed().variables.size()) {
  read_function_values();
}

void FormulaGrounder::start(base::SourceRange blame) {
  spent_ = 0;
  failed_ = false;
  blame_ = blame;
  if (environment_.size() < typed_->variables.size()) {
    environment_.resize(typed_->variables.size());
  }
}

bool FormulaGrounder::spend(std::int64_t more) {
  if (failed_) return false;
  if (__builtin_add_overflow(spent_, more, &spent_))
    spent_ = std::numeric_limits<std::int64_t>::max();
  if (spent_ > options_.max_instances) {
    sink_->error(DiagnosticCode::kTooManyInstances, blame_, options_.max_instances);
    failed_ = true;
  }
  if (!failed_ && options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed)) {
    sink_->error(DiagnosticCode::kGroundingStopped, blame_);
    failed_ = true;
  }
  return !failed_;
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
    stack.push_back({&formula, 0, {}, false, {}, false});
    have_result = false;
    if (is_quantifier(formula.kind)) stack.back().exhausted = !begin_instances(stack.back());
  };
  push(root);
  while (!stack.empty() && !failed_) {
    auto& frame = stack.back();
    const auto kind = frame.formula->kind;
    bool decided = false;
    if (have_result) {
      have_result = false;
      if (!result) {
        frame.discarded = true;
      } else {
        frame.parts.push_back(*result);
        const auto& formulas = model_->formulas();
        decided = ((kind == FormulaKind::kAnd || kind == FormulaKind::kForall) &&
                   *result == formulas.falsity()) ||
                  ((kind == FormulaKind::kOr || kind == FormulaKind::kExists) &&
                   *result == formulas.truth());
      }
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
      for (const auto variable : frame.formula->variables) unbind(variable);
      stack.pop_back();
    }
  }
  if (failed_) return std::nullopt;
  return result;
}

bool FormulaGrounder::begin_instances(Frame& frame) {
  frame.odometer.assign(frame.formula->variables.size(), 0);
  std::int64_t instances = 1;
  for (const auto variable : frame.formula->variables) {
    const auto& domain = model_->universe().domain(typed_->variables[variable].sort);
    if (domain.empty()) return false;
    bind(variable, domain[0]);
    if (__builtin_mul_overflow(instances, static_cast<std::int64_t>(domain.size()), &instances)) {
      instances = std::numeric_limits<std::int64_t>::max();
    }
  }
  // The whole product is paid for at once: what is too large is refused before it is begun.
  return spend(instances);
}

bool FormulaGrounder::next_instance(Frame& frame) {
  const auto& variables = frame.formula->variables;
  for (std::size_t i = variables.size(); i-- > 0;) {
    const auto& domain = model_->universe().domain(typed_->variables[variables[i]].sort);
    if (++frame.odometer[i] < domain.size()) {
      bind(variables[i], domain[frame.odometer[i]]);
      return spend(0);
    }
    frame.odometer[i] = 0;
    bind(variables[i], domain[0]);
  }
  return false;
}

std::optional<FormulaId> FormulaGrounder::combine(Frame& frame) {
  auto& formulas = model_->formulas();
  auto& parts = frame.parts;
  const bool all_there = !frame.discarded;
  switch (frame.formula->kind) {
    case FormulaKind::kAnd: {
      const auto value = formulas.conjunction(std::move(parts));
      if (all_there || value == formulas.falsity()) return value;
      return std::nullopt;
    }
    case FormulaKind::kOr: {
      const auto value = formulas.disjunction(std::move(parts));
      if (all_there || value == formulas.truth()) return value;
      return std::nullopt;
    }
    case FormulaKind::kForall:
    case FormulaKind::kExists: {
      const bool beyond = parts.empty() && frame.discarded;
      if (beyond && options_.meaning == Meaning::kStandard) return std::nullopt;
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
  return formula.kind == FormulaKind::kAtom ? atom(formula) : compare(formula);
}

std::optional<FormulaId> FormulaGrounder::atom(const TypedFormula& formula) {
  std::vector<GroundTermId> arguments;
  for (const auto id : formula.terms) {
    const auto value = term(id);
    if (!value) return std::nullopt;
    arguments.push_back(*value);
  }
  const auto& symbol = typed_->symbols[formula.predicate];
  if (!arguments_fit(symbol, arguments)) return std::nullopt;
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
  std::string name = symbol.name + "(";
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (i > 0) name += ',';
    name += terms.text(arguments[i], *typed_);
  }
  return model_->named_atom(AtomKind::kPredicate, name + ")", std::nullopt);
}

/// Like the events they speak of, effects exist before the last timepoint only.
std::optional<FormulaId> FormulaGrounder::effect_atom(EffectKind kind,
                                                      const std::vector<GroundTermId>& arguments) {
  const auto event = model_->event_number(arguments[0]);
  const auto fluent = model_->fluent_number(arguments[1]);
  const auto t = static_cast<Timepoint>(model_->terms()[arguments[2]].integer);
  if (!event || !fluent || t >= model_->horizon() || rows_ == nullptr) return std::nullopt;
  return rows_->holds(kind, *event, *fluent, t, model_->formulas());
}

std::optional<FormulaId> FormulaGrounder::compare(const TypedFormula& formula) {
  const auto left = term(formula.terms[0]);
  const auto right = term(formula.terms[1]);
  if (!left || !right) return std::nullopt;
  auto& formulas = model_->formulas();
  const auto a = model_->terms()[*left].integer;
  const auto b = model_->terms()[*right].integer;
  switch (formula.compare) {
    case CompareOp::kEqual:
      return formulas.constant(*left == *right);
    case CompareOp::kNotEqual:
      return formulas.constant(*left != *right);
    case CompareOp::kLess:
      return formulas.constant(a < b);
    case CompareOp::kLessEqual:
      return formulas.constant(a <= b);
    case CompareOp::kGreater:
      return formulas.constant(a > b);
    case CompareOp::kGreaterEqual:
      return formulas.constant(a >= b);
  }
  return std::nullopt;
}

bool FormulaGrounder::arguments_fit(const Symbol& symbol,
                                    const std::vector<GroundTermId>& arguments) const {
  if (arguments.size() != symbol.arguments.size()) return false;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (!model_->universe().contains(symbol.arguments[i], arguments[i], model_->terms())) {
      return false;
    }
  }
  return true;
}

}  // namespace parallax::compiler
