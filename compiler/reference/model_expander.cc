#include "compiler/reference/model_expander.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "compiler/base/ground_name.h"

namespace parallax::compiler {

ModelExpander::ModelExpander(const TypedModel& model, ReferenceBudget& budget, ExpandedModel& out)
    : model_(model), budget_(budget), out_(out), terms_(model, budget) {
  environment_.resize(model.variables.size());
  bound_.resize(model.variables.size(), false);
}

void ModelExpander::begin() {
  out_.too_deep_ = too_deep();
  if (out_.too_deep_) budget_.spend_all();
  if (!budget_.spent()) number_atoms();
}

std::vector<std::string> ModelExpander::values(VariableId variable) const {
  std::vector<std::string> out;
  for (const auto value : terms_.domain(model_.variables[variable].sort)) {
    out.push_back(terms_.text(value));
  }
  return out;
}

bool ModelExpander::bind(VariableId variable, const std::string& value) {
  for (const auto candidate : terms_.domain(model_.variables[variable].sort)) {
    if (terms_.text(candidate) != value) continue;
    environment_[variable.index()] = candidate;
    bound_[variable.index()] = true;
    return true;
  }
  return false;
}

void ModelExpander::run() {
  out_.too_deep_ = too_deep();
  if (out_.too_deep_) budget_.spend_all();
  if (budget_.spent()) return;
  number_atoms();
  if (budget_.spent()) return;
  expand_effects();
  expand_axioms();
  expand_trajectories();
  complete();
}

bool ModelExpander::too_deep() const {
  if (ReferenceTerms::depth(model_, kMaxReferenceDepth) > kMaxReferenceDepth) return true;
  // A part is added to the store before the formula around it.
  std::vector<std::size_t> depths(model_.formulas.size(), 1);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    for (const auto child : model_.formulas[model_.formulas.id_at(i)].children) {
      depths[i] = std::max(depths[i], depths[child.index()] + 1);
    }
    if (depths[i] > kMaxReferenceDepth) return true;
  }
  return false;
}

void ModelExpander::number_atoms() {
  out_.horizon_ = static_cast<std::int64_t>(terms_.domain(*model_.core.time).size()) - 1;
  for (const auto value : terms_.domain(*model_.core.fluent)) {
    const auto& text = terms_.text(value);
    out_.fluent_numbers_.emplace(text, static_cast<std::uint32_t>(out_.fluents_.size()));
    out_.fluents_.push_back(text);
    const auto symbol = model_.find_symbol(base::symbol_of(text));
    out_.fluent_symbols_.push_back(&model_.symbols[*symbol]);
  }
  for (const auto value : terms_.domain(*model_.core.event)) {
    const auto& text = terms_.text(value);
    out_.event_numbers_.emplace(text, static_cast<std::uint32_t>(out_.events_.size()));
    out_.events_.push_back(text);
  }
  const auto stride = static_cast<std::int64_t>(2 * out_.fluents_.size() + out_.events_.size());
  if (!budget_.spend(stride * (out_.horizon_ + 1))) return;
  out_.rows_.resize(static_cast<std::size_t>(std::max<std::int64_t>(out_.horizon_, 0)) *
                    out_.fluents_.size());
}

void ModelExpander::for_each(const std::vector<VariableId>& variables,
                             const std::function<void()>& visit, std::size_t position) {
  if (position == variables.size()) {
    if (budget_.spend()) visit();
    return;
  }
  const auto variable = variables[position];
  if (bound_[variable.index()]) return for_each(variables, visit, position + 1);
  for (const auto value : terms_.domain(model_.variables[variable].sort)) {
    if (budget_.spent()) return;
    environment_[variable.index()] = value;
    for_each(variables, visit, position + 1);
  }
}

ReferenceFormula ModelExpander::measured(Node node) const {
  ReferenceFormula formula{node, 0};
  for (const auto atom : out_.trees_.atoms_of(node)) {
    formula.needed = std::max(formula.needed, out_.needed(atom));
  }
  for (const bool negative : {false, true}) {
    for (const auto effect : out_.trees_.effects_of(node, negative)) {
      formula.needed = std::max(formula.needed, out_.effects_[effect].needed);
    }
  }
  return formula;
}

void ModelExpander::expand_effects() {
  for (std::size_t i = 0; i < model_.effects.size(); ++i) expand_effect(i);
  effects_known_ = true;
  measure_effects();
}

/// Computes the horizon that each effect needs: a condition needs those of the effects in it.
void ModelExpander::measure_effects() {
  for (auto& effect : out_.effects_) effect.needed = effect.time + 1;
  for (bool grown = !out_.effects_.empty(); grown;) {
    grown = false;
    for (auto& rows : out_.rows_) {
      for (auto& row : rows) row.condition = measured(row.condition.node);
    }
    for (auto& effect : out_.effects_) {
      const auto before = effect.needed;
      for (const auto& row : out_.rows(effect.fluent, effect.time)) {
        if (row.kind != effect.kind || row.event != effect.event) continue;
        effect.needed = std::max(effect.needed, row.condition.needed);
      }
      grown = grown || effect.needed != before;
    }
  }
}

/// An instance whose terms or condition do not exist gives no row.
void ModelExpander::expand_effect(std::size_t index) {
  const auto& effect = model_.effects[index];
  for_each(effect.variables, [&] {
    const auto event = term(effect.event);
    const auto fluent = term(effect.fluent);
    const auto time = term(effect.time);
    if (!event || !fluent || !time) return;
    const auto e = out_.event(terms_.text(*event));
    const auto f = out_.fluent(terms_.text(*fluent));
    const auto t = terms_.number(*time);
    if (!e || !f || !t || *t < 0 || *t >= out_.horizon_) return;
    const auto before = out_.trees_.size();
    const auto condition = expand(effect.condition);
    if (!condition || *condition == FormulaTrees::kFalsity) {
      out_.trees_.rewind(before);
      return;
    }
    out_.rows_[static_cast<std::size_t>(*t) * out_.fluents_.size() + *f].push_back(
        {effect.kind, *e, measured(*condition), index});
  });
}

void ModelExpander::expand_axioms() {
  for (std::size_t i = 0; i < model_.axioms.size() && !budget_.spent(); ++i) {
    const auto whole = expand(model_.axioms[i].formula);
    if (!whole) {
      out_.silent_axioms_.push_back(i);
      continue;
    }
    for (const auto conjunct : out_.trees_.conjuncts(*whole)) {
      if (conjunct == FormulaTrees::kTruth) continue;
      const auto size = static_cast<std::int64_t>(out_.trees_.atoms_of(conjunct).size());
      out_.conjuncts_.push_back({i, measured(conjunct), size});
    }
  }
}

void ModelExpander::expand_trajectories() {
  for (std::size_t i = 0; i < model_.trajectories.size(); ++i) expand_trajectory(i);
}

/// The development begins with an event at t >= 0 and lasts a positive time, up to the horizon.
void ModelExpander::expand_trajectory(std::size_t index) {
  const auto& axiom = model_.trajectories[index];
  for_each(axiom.variables, [&] {
    const auto fluent = term(axiom.fluent);
    const auto target = term(axiom.target);
    const auto time = term(axiom.time);
    const auto offset = term(axiom.offset);
    if (!fluent || !target || !time || !offset) return;
    const auto f1 = out_.fluent(terms_.text(*fluent));
    const auto f2 = out_.fluent(terms_.text(*target));
    const auto t = terms_.number(*time);
    const auto d = terms_.number(*offset);
    if (!f1 || !f2 || !t || !d || *t < 0 || *d <= 0 || *d > out_.horizon_ - *t) return;
    const auto before = out_.trees_.size();
    const auto condition = expand(axiom.condition);
    if (!condition || *condition == FormulaTrees::kFalsity) {
      out_.trees_.rewind(before);
      return;
    }
    out_.paths_.push_back({measured(*condition), *f1, *f2, *t, *t + *d, index});
  });
}

std::vector<std::uint32_t> ModelExpander::atoms_of(SymbolId predicate) const {
  std::vector<std::uint32_t> atoms;
  const auto& core = model_.core;
  if (predicate == core.holds_at || predicate == core.released_at || predicate == core.happens) {
    const bool events = predicate == core.happens;
    const auto last = events ? out_.horizon_ - 1 : out_.horizon_;
    const auto count = events ? out_.events_.size() : out_.fluents_.size();
    for (std::int64_t t = 0; t <= last; ++t) {
      for (std::uint32_t i = 0; i < count; ++i) {
        atoms.push_back(events                          ? out_.happens(i, t)
                        : predicate == core.released_at ? out_.released(i, t)
                                                        : out_.holds(i, t));
      }
    }
    return atoms;
  }
  const auto prefix = model_.symbols[predicate].name + "(";
  for (std::size_t i = 0; i < out_.predicates_.size(); ++i) {
    if (out_.predicates_[i].starts_with(prefix)) {
      atoms.push_back(static_cast<std::uint32_t>(out_.timed_atoms() + i));
    }
  }
  return atoms;
}

/// Is the formula a definition? One over effects (Clipped, ECCausal) gives no reason for the
/// predicates that define it.
bool ModelExpander::is_definition(TypedFormulaId id) const {
  const auto& formula = model_.formulas[id];
  return formula.kind == FormulaKind::kForall ? is_definition(formula.children[0])
                                              : formula.kind == FormulaKind::kIff;
}

/// For every completed atom, the conjuncts of the label that mention it.
void ModelExpander::complete() {
  for (std::size_t c = 0; c < model_.completions.size() && !budget_.spent(); ++c) {
    const auto& completion = model_.completions[c];
    std::map<std::uint32_t, ExpandedModel::Completed> completed;
    for (const auto atom : atoms_of(completion.predicate)) completed[atom] = {c, atom, {}};
    for (std::size_t i = 0; i < out_.conjuncts_.size(); ++i) {
      const auto& axiom = model_.axioms[out_.conjuncts_[i].axiom];
      if (axiom.mentions_effects && is_definition(axiom.formula)) continue;
      if (completion.label && *completion.label != axiom.label) continue;
      for (const auto atom : out_.trees_.atoms_of(out_.conjuncts_[i].formula.node)) {
        const auto found = completed.find(atom);
        if (found != completed.end()) found->second.reasons.push_back(i);
      }
    }
    for (auto& [atom, entry] : completed) out_.completed_.push_back(std::move(entry));
  }
}

std::optional<ModelExpander::Node> ModelExpander::expand(TypedFormulaId id) {
  const auto& formula = model_.formulas[id];
  const auto before = out_.trees_.size();
  std::optional<Node> node;
  switch (formula.kind) {
    case FormulaKind::kTrue:
    case FormulaKind::kFalse:
      return FormulaTrees::constant(formula.kind == FormulaKind::kTrue);
    case FormulaKind::kAtom:
      return atom(formula);
    case FormulaKind::kCompare:
      return compare(formula);
    case FormulaKind::kForall:
    case FormulaKind::kExists:
      node = quantified(formula);
      break;
    case FormulaKind::kAggregate:
      node = aggregate(formula);
      break;
    case FormulaKind::kNot:
    case FormulaKind::kAnd:
    case FormulaKind::kOr:
    case FormulaKind::kImplies:
    case FormulaKind::kIff:
      node = connected(formula);
      break;
    case FormulaKind::kTemporal:
      return std::nullopt;  // TemporalTruth takes these apart
  }
  // The parts of a formula that became a constant, or nothing, are not needed any more.
  if (!node || *node == FormulaTrees::kTruth || *node == FormulaTrees::kFalsity) {
    out_.trees_.rewind(before);
  }
  return node;
}

std::optional<ModelExpander::Node> ModelExpander::connected(const TypedFormula& formula) {
  std::vector<Node> parts;
  for (const auto child : formula.children) {
    if (!budget_.spend()) return std::nullopt;
    const auto part = expand(child);
    if (!part) return std::nullopt;
    parts.push_back(*part);
  }
  return out_.trees_.connect(formula.kind, parts);
}

std::optional<ModelExpander::Node> ModelExpander::quantified(const TypedFormula& formula) {
  std::vector<Node> parts;
  bool tried = false, exists = false;
  const auto neutral = FormulaTrees::constant(formula.kind == FormulaKind::kForall);
  for_each(formula.variables, [&] {
    tried = true;
    const auto part = expand(formula.children[0]);
    exists = exists || part.has_value();
    if (part && *part != neutral) parts.push_back(*part);
  });
  if (tried && !exists) return std::nullopt;
  return out_.trees_.connect(
      formula.kind == FormulaKind::kForall ? FormulaKind::kAnd : FormulaKind::kOr, parts);
}

std::optional<ModelExpander::Node> ModelExpander::compare(const TypedFormula& formula) {
  const auto left = term(formula.terms[0]);
  const auto right = term(formula.terms[1]);
  if (!left || !right) return std::nullopt;
  if (formula.compare == CompareOp::kEqual) return FormulaTrees::constant(*left == *right);
  if (formula.compare == CompareOp::kNotEqual) return FormulaTrees::constant(*left != *right);
  const auto a = terms_.number(*left);
  const auto b = terms_.number(*right);
  if (!a || !b) return std::nullopt;  // only integers have an order
  return FormulaTrees::constant(compares(*a, formula.compare, *b));
}

/// Instances that do not exist are not counted; if all are such, neither does the whole. A sum
/// beyond 64 bits is an error of the model, which is not checked then.
std::optional<ModelExpander::Node> ModelExpander::aggregate(const TypedFormula& formula) {
  const auto limit = term(formula.terms[0]);
  const auto number = limit ? terms_.number(*limit) : std::nullopt;
  if (!number) return std::nullopt;
  FormulaTrees::Sum sum{formula.compare, *number, {}};
  std::vector<Node> parts;
  std::int64_t largest = 0;
  bool tried = false;
  for_each(formula.variables, [&] {
    tried = true;
    const auto part = expand(formula.children[0]);
    const auto weight = formula.terms.size() == 2 ? term(formula.terms[1]) : std::nullopt;
    const auto value = weight ? terms_.number(*weight) : std::nullopt;
    if (!part || (formula.terms.size() == 2 && !value)) return;
    parts.push_back(*part);
    sum.weights.push_back(value.value_or(1));
    const auto least = -std::numeric_limits<std::int64_t>::max();
    const auto size = std::abs(std::max(sum.weights.back(), least));
    if (__builtin_add_overflow(largest, size, &largest)) budget_.spend_all();
  });
  if (budget_.spent() || (tried && parts.empty())) return std::nullopt;
  return out_.trees_.compared(std::move(sum), parts);
}

std::optional<ModelExpander::Node> ModelExpander::atom(const TypedFormula& formula) {
  const auto& symbol = model_.symbols[formula.predicate];
  const auto arguments = terms_.arguments(symbol, formula.terms, environment_);
  if (!arguments) return std::nullopt;
  const auto& core = model_.core;
  if (formula.predicate == core.happens) return event_atom(*arguments);
  if (formula.predicate == core.holds_at || formula.predicate == core.released_at) {
    const auto fluent = out_.fluent(terms_.text((*arguments)[0]));
    const auto t = terms_.number((*arguments)[1]);
    if (!fluent || !t) return std::nullopt;
    const bool holds = formula.predicate == core.holds_at;
    return out_.trees_.atom(holds ? out_.holds(*fluent, *t) : out_.released(*fluent, *t));
  }
  if (formula.predicate == core.initiates) return effect_atom(EffectKind::kInitiates, *arguments);
  if (formula.predicate == core.terminates) {
    return effect_atom(EffectKind::kTerminates, *arguments);
  }
  if (formula.predicate == core.releases) return effect_atom(EffectKind::kReleases, *arguments);
  const auto text = terms_.applied(symbol, *arguments);
  const auto number = static_cast<std::uint32_t>(out_.atom_count());
  const auto [found, is_new] = out_.predicate_numbers_.emplace(text, number);
  if (is_new) out_.predicates_.push_back(text);
  return out_.trees_.atom(found->second);
}

/// Events before the last timepoint exist, however the timepoint is written.
std::optional<ModelExpander::Node> ModelExpander::event_atom(const std::vector<Value>& arguments) {
  const auto event = out_.event(terms_.text(arguments[0]));
  const auto t = terms_.number(arguments[1]);
  if (!event || !t) return std::nullopt;
  if (*t < out_.horizon_) return out_.trees_.atom(out_.happens(*event, *t));
  if (events_end_) return FormulaTrees::kFalsity;
  return std::nullopt;
}

/// An effect stays an atom: what some effect axiom says of it (circumscription) is no part of the
/// formula that mentions it. Where it is plain that no effect axiom, or one without a condition,
/// brings it about, it is a constant.
std::optional<ModelExpander::Node> ModelExpander::effect_atom(EffectKind kind,
                                                              const std::vector<Value>& arguments) {
  const auto event = out_.event(terms_.text(arguments[0]));
  const auto fluent = out_.fluent(terms_.text(arguments[1]));
  const auto t = terms_.number(arguments[2]);
  if (!event || !fluent || !t || *t >= out_.horizon_) return std::nullopt;
  ExpandedModel::EffectAtom effect{kind, *event, *fluent, *t, *t + 1};
  if (effects_known_) {
    std::vector<Node> conditions;
    for (const auto& row : out_.rows(*fluent, *t)) {
      if (row.kind != kind || row.event != *event) continue;
      conditions.push_back(row.condition.node);
      effect.needed = std::max(effect.needed, row.condition.needed);
    }
    const auto any = out_.trees_.connect(FormulaKind::kOr, conditions);
    if (any == FormulaTrees::kTruth || any == FormulaTrees::kFalsity) return any;
  }
  const auto number = static_cast<std::uint32_t>(out_.effects_.size());
  const auto [found, added] =
      effect_numbers_.try_emplace(std::tuple(kind, *event, *fluent, *t), number);
  if (added) out_.effects_.push_back(effect);
  return out_.trees_.effect(found->second);
}

}  // namespace parallax::compiler
