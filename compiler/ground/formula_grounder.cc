// Expands a typed formula into a propositional one: connectives part by part, quantifiers by
// joins.
//
// Atoms and comparisons are evaluated under the values that variables have. They may name
// something that does not exist (a timepoint beyond the horizon, an event at the last one);
// connectives pass that on, and the innermost quantifier leaves the instance out. The instances
// of a quantifier come from a plan of filters, equations and look-ups in tables of the atoms
// that may be true (instance_plan.cc, instance_search.cc). An assignment that no join yields
// makes a conjunct false or names nothing, so it says nothing. If no instance that was yielded
// exists, the product of the sorts is walked until one exists: that tells an empty quantifier
// from one that says nothing itself. An instance that decides ends its quantifier.
//
// Cost: a budget counts the rows and the instances. A bare product beyond it, or an estimate a
// thousand times beyond it, is refused before it is begun.

#include "compiler/ground/formula_grounder.h"

#include <algorithm>
#include <array>
#include <utility>

#include "compiler/ground/weighted_sum.h"

namespace parallax::compiler {
namespace {

/// Aggregates have instances as quantifiers do.
bool is_quantifier(FormulaKind kind) {
  return kind == FormulaKind::kForall || kind == FormulaKind::kExists ||
         kind == FormulaKind::kAggregate;
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
  std::vector<std::int64_t> weights;  // of the parts of an aggregate
  bool discarded = false;             // some part named nothing that exists
  bool exists = false;                // some part named something that exists
  bool exhausted = false;
  // Quantifiers:
  std::vector<VariableId> open;         // its variables without a value from outside
  std::vector<GroundTermId> instances;  // one after the other
  std::size_t next = 0;                 // the next instance
  bool in_product = false;              // only looking for an instance that exists
  std::vector<std::size_t> odometer;
};

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
  depth_ = 0;
  const auto push = [&](TypedFormulaId id) {
    const auto& formula = typed_->formulas[id];
    if (is_leaf(formula.kind)) {
      result = leaf(formula);
      have_result = true;
      return;
    }
    if (formula.kind == FormulaKind::kAggregate && !number(formula.terms[0])) {
      result.reset();
      have_result = true;
      return;
    }
    stack.emplace_back();
    stack.back().formula = &formula;
    have_result = false;
    if (!is_quantifier(formula.kind)) return;
    ++depth_;
    begin_instances(stack.back(), id);
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
      if (is_quantifier(kind)) --depth_;
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

/// Notes the result of a part or an instance. True: the rest cannot change the outcome.
bool FormulaGrounder::take_part(Frame& frame, std::optional<FormulaId> part) {
  std::optional<std::int64_t> weight = 1;
  if (part && frame.formula->kind == FormulaKind::kAggregate && frame.formula->terms.size() == 2) {
    weight = number(frame.formula->terms[1]);
  }
  if (!part || !weight) {
    frame.discarded = true;
    return false;
  }
  frame.exists = true;
  if (frame.in_product) return true;
  frame.parts.push_back(*part);
  const auto kind = frame.formula->kind;
  if (kind == FormulaKind::kAggregate) frame.weights.push_back(*weight);
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
    case FormulaKind::kAggregate:
      if (frame.discarded && !frame.exists) return std::nullopt;
      return compared_sum(frame);
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
    case FormulaKind::kTemporal:
      break;
  }
  PARALLAX_REQUIRE(false, "a frame is a connective or a quantifier");
  return std::nullopt;
}

std::optional<FormulaId> FormulaGrounder::compared_sum(Frame& frame) {
  const auto limit = number(frame.formula->terms[0]);
  std::vector<WeightedFormula> terms;
  for (std::size_t i = 0; i < frame.parts.size(); ++i) {
    terms.push_back({frame.parts[i], frame.weights[i]});
  }
  const auto sum = weighted_sum(*model_, terms, *limit);
  if (!sum) {
    terms_.report_overflow(frame.formula->source);
    return std::nullopt;
  }
  return compare_sum(*model_, *sum, frame.formula->compare,
                     [&](std::size_t nodes) { return spend(static_cast<std::int64_t>(nodes)); });
}

std::optional<std::int64_t> FormulaGrounder::number(TermId id) {
  const auto value = term(id);
  if (!value || model_->terms()[*value].kind != TermKind::kInteger) return std::nullopt;
  return model_->terms()[*value].integer;
}

std::optional<FormulaId> FormulaGrounder::leaf(const TypedFormula& formula) {
  if (formula.kind == FormulaKind::kTrue) return model_->formulas().truth();
  if (formula.kind == FormulaKind::kFalse) return model_->formulas().falsity();
  if (formula.kind == FormulaKind::kAtom) return atom(formula);
  const auto value = terms_.compare(formula);
  if (!value) return std::nullopt;
  return model_->formulas().constant(*value);
}

/// HoldsAt, ReleasedAt and Happens.
std::optional<FormulaId> FormulaGrounder::timed_atom(const TypedFormula& formula) {
  const auto what = term(formula.terms[0]);
  const auto when = what ? term(formula.terms[1]) : std::nullopt;
  if (!when) return std::nullopt;
  const std::array arguments = {*what, *when};
  if (!terms_.arguments_fit(typed_->symbols[formula.predicate], arguments)) return std::nullopt;
  const auto t = static_cast<Timepoint>(model_->terms()[*when].integer);
  if (formula.predicate == typed_->core.happens) return occurrence(*what, t);
  const auto number = model_->fluent_number(*what);
  if (!number) return std::nullopt;
  return formula.predicate == typed_->core.holds_at ? model_->holds(*number, t)
                                                    : model_->released(*number, t);
}

std::optional<FormulaId> FormulaGrounder::atom(const TypedFormula& formula) {
  const auto& core = typed_->core;
  if (formula.predicate == core.holds_at || formula.predicate == core.released_at ||
      formula.predicate == core.happens) {
    return timed_atom(formula);
  }
  std::vector<GroundTermId> arguments;
  for (const auto id : formula.terms) {
    const auto value = term(id);
    if (!value) return std::nullopt;
    arguments.push_back(*value);
  }
  const auto& symbol = typed_->symbols[formula.predicate];
  if (!terms_.arguments_fit(symbol, arguments)) return std::nullopt;
  if (formula.predicate == core.initiates) return effect_atom(EffectKind::kInitiates, arguments);
  if (formula.predicate == core.terminates) return effect_atom(EffectKind::kTerminates, arguments);
  if (formula.predicate == core.releases) return effect_atom(EffectKind::kReleases, arguments);
  return model_->predicate(model_->terms().apply(formula.predicate, arguments));
}

/// Before the last timepoint only. Whether the timepoint is written as a number or as a variable
/// makes no difference: a longer horizon must not change the meaning at earlier timepoints.
std::optional<FormulaId> FormulaGrounder::occurrence(GroundTermId event, Timepoint t) const {
  const auto number = model_->event_number(event);
  if (!number) return std::nullopt;
  if (t < model_->horizon()) return model_->happens(*number, t);
  if (names_last_events_) return model_->happens_last(*number);
  if (meaning_ == Meaning::kDecreasoner) {
    if (!whole_axiom_ || depth_ > 0) return std::nullopt;
    return model_->happens_last(*number);
  }
  return std::nullopt;
}

/// Like the events they speak of, effects exist before the last timepoint only.
std::optional<FormulaId> FormulaGrounder::effect_atom(EffectKind kind,
                                                      const std::vector<GroundTermId>& arguments) {
  const auto event = model_->event_number(arguments[0]);
  const auto fluent = model_->fluent_number(arguments[1]);
  const auto t = static_cast<Timepoint>(model_->terms()[arguments[2]].integer);
  if (!event || !fluent || t >= model_->horizon()) return std::nullopt;
  if (effect_atoms_) return effect_atoms_(kind, *event, *fluent, t);
  if (rows_ == nullptr) return std::nullopt;
  if (meaning_ == Meaning::kDecreasoner && typed_->options.encoding != 3) {
    return effect_in_place(kind, *event, *fluent, t);
  }
  return rows_->holds(kind, *event, *fluent, t, *model_);
}

/// With encoding 2 the 2005 reasoner replaces an effect atom by its result: if the event happens,
/// the fluent holds next (no longer holds, is released).
FormulaId FormulaGrounder::effect_in_place(EffectKind kind, std::uint32_t event,
                                           std::uint32_t fluent, Timepoint t) const {
  auto& formulas = model_->formulas();
  const auto happens = model_->happens(event, t);
  const auto released = model_->released(fluent, t + 1);
  if (kind == EffectKind::kReleases) return formulas.implication(happens, released);
  const auto after = model_->holds(fluent, t + 1);
  const bool up = kind == EffectKind::kInitiates;
  return formulas.implication(happens, formulas.conjunction(up ? after : ~after, ~released));
}

// --- quantifiers ---

void FormulaGrounder::begin_instances(Frame& frame, TypedFormulaId id) {
  for (const auto variable : frame.formula->variables) {
    if (!terms_.is_bound(variable)) frame.open.push_back(variable);
  }
  const auto ranges_over_nothing = [&](VariableId variable) {
    return model_->universe().domain(typed_->variables[variable].sort).empty();
  };
  if (std::any_of(frame.open.begin(), frame.open.end(), ranges_over_nothing)) {
    frame.exhausted = true;  // true or false, whatever stands inside
    return;
  }
  const auto& known = quantifier(id, frame);
  for (const auto atom : known.outer_atoms) {
    if (!beyond_horizon(typed_->formulas[atom])) continue;
    frame.discarded = frame.exhausted = true;
    return;
  }
  if (runnable(known.plan, frame.open)) {
    frame.instances = InstanceSearch(terms_, possible_).run(known.plan, frame.open);
  }
  frame.exhausted = failed() || !next_instance(frame);
}

/// Refuses an instantiation that is too large before it begins: a bare product by its size, a join
/// if its expected size exceeds the limit a thousandfold.
bool FormulaGrounder::runnable(const InstancePlan& plan, const std::vector<VariableId>& open) {
  constexpr double kBeyondReason = 1000.0;
  const auto limit = static_cast<double>(terms_.options().max_instances);
  const bool fits = plan.estimate <= (plan.is_product ? limit : kBeyondReason * limit);
  return fits || open.empty() || spend(terms_.options().max_instances + 1);
}

const FormulaGrounder::Quantifier& FormulaGrounder::quantifier(TypedFormulaId id,
                                                               const Frame& frame) {
  const auto found = quantifiers_.find(id.index());
  if (found != quantifiers_.end()) return found->second;
  const bool negated = frame.formula->kind == FormulaKind::kForall;
  Quantifier made;
  made.plan = plan_instances(frame.open, conjuncts_of(*typed_, frame.formula->children[0], negated),
                             *model_, possible_, [&](VariableId v) { return terms_.is_bound(v); });
  if (meaning_ == Meaning::kStandard) made.outer_atoms = outer_atoms(*frame.formula);
  return quantifiers_.emplace(id.index(), std::move(made)).first->second;
}

/// Timed atoms in the body whose timepoint is fixed outside: where it does not exist, no instance
/// does.
std::vector<TypedFormulaId> FormulaGrounder::outer_atoms(const TypedFormula& root) const {
  std::vector<TypedFormulaId> found;
  std::vector<TypedFormulaId> todo = root.children;
  while (!todo.empty()) {
    const auto& formula = typed_->formulas[todo.back()];
    const auto id = todo.back();
    todo.pop_back();
    // Atoms inside an inner quantifier are left to that quantifier.
    if (is_quantifier(formula.kind)) continue;
    todo.insert(todo.end(), formula.children.begin(), formula.children.end());
    const auto& core = typed_->core;
    if (formula.kind != FormulaKind::kAtom) continue;
    if (formula.predicate != core.happens && formula.predicate != core.holds_at &&
        formula.predicate != core.released_at) {
      continue;
    }
    const auto all = variables_of(*typed_, formula.terms[1]);
    if (std::all_of(all.begin(), all.end(), [&](VariableId v) { return terms_.is_bound(v); })) {
      found.push_back(id);
    }
  }
  return found;
}

bool FormulaGrounder::beyond_horizon(const TypedFormula& formula) {
  const auto time = terms_.term(formula.terms[1]);
  if (!time) return true;
  const auto t = model_->terms()[*time].integer;
  if (t < 0 || t > model_->horizon()) return true;
  return formula.predicate == typed_->core.happens && t == model_->horizon() && !names_last_events_;
}

bool FormulaGrounder::next_instance(Frame& frame) {
  if (frame.in_product) return next_of_product(frame);
  const auto width = frame.open.size();
  const auto count = width == 0 ? 1 : frame.instances.size() / width;
  if (frame.next < count) {
    for (std::size_t i = 0; i < width; ++i) {
      bind(frame.open[i], frame.instances[frame.next * width + i]);
    }
    ++frame.next;
    return spend(1);
  }
  // Every instance that could say anything has been seen. If none of them exists, the others
  // decide whether the formula itself does.
  if (frame.exists || meaning_ == Meaning::kDecreasoner) return false;
  frame.in_product = true;
  for (const auto variable : frame.open) {
    const auto& domain = model_->universe().domain(typed_->variables[variable].sort);
    bind(variable, domain[0]);
  }
  frame.odometer.assign(width, 0);
  return width > 0;
}

bool FormulaGrounder::next_of_product(Frame& frame) {
  for (std::size_t i = frame.open.size(); i-- > 0;) {
    const auto& domain = model_->universe().domain(typed_->variables[frame.open[i]].sort);
    if (++frame.odometer[i] < domain.size()) {
      bind(frame.open[i], domain[frame.odometer[i]]);
      return spend(1);
    }
    frame.odometer[i] = 0;
    bind(frame.open[i], domain[0]);
  }
  return false;
}

std::vector<GroundTermId> FormulaGrounder::instances(const std::vector<VariableId>& variables,
                                                     const std::vector<Conjunct>& conjuncts) {
  const auto plan = plan_instances(variables, conjuncts, *model_, possible_,
                                   [&](VariableId v) { return terms_.is_bound(v); });
  if (!runnable(plan, variables)) return {};
  return InstanceSearch(terms_, possible_).run(plan, variables);
}

}  // namespace parallax::compiler
