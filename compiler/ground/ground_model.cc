#include "compiler/ground/ground_model.h"

#include <algorithm>
#include <span>
#include <utility>

#include "compiler/artifact/atom.h"
#include "compiler/formula/formula.h"

namespace parallax::compiler {
namespace {

std::string row_line(const GroundModel& model, const EffectRow& row, const std::string& time,
                     FormulaText& formulas, const base::SourceFiles* files) {
  const auto name = [&](GroundTermId term) { return model.terms().text(term, model.typed()); };
  auto line = origin_text(model.origins()[row.origin], files) + ": " +
              std::string(effect_word(row.kind)) + '(' + name(model.events()[row.event]) + ',' +
              name(model.fluents()[row.fluent]) + ',' + time + ')';
  if (row.condition != model.formulas().truth()) line += " if " + formulas.text(row.condition);
  return line + '\n';
}

/// The rest of the formula where `given` is true, if `given` is one of its conjuncts.
FormulaId where(FormulaId given, FormulaId formula, FormulaStore& formulas) {
  if (given == formulas.truth()) return formula;
  if (formula == given) return formulas.truth();
  if (formula.negated() || formulas.kind(formula) != FormulaNodeKind::kAnd) return formula;
  const auto parts = formulas.children(formula);
  std::vector<FormulaId> rest;
  for (const auto part : parts) {
    if (part == ~given) return formulas.falsity();
    if (part != given) rest.push_back(part);
  }
  return rest.size() == parts.size() ? formula : formulas.conjunction(std::move(rest));
}

}  // namespace

GroundModel::GroundModel(const TypedModel& model, GroundTermStore terms, Universe universe)
    : typed_(&model), terms_(std::move(terms)), universe_(std::move(universe)) {
  if (model.core.fluent) fluents_ = universe_.domain(*model.core.fluent);
  if (model.core.event) events_ = universe_.domain(*model.core.event);
  for (std::uint32_t i = 0; i < fluents_.size(); ++i) fluent_numbers_.emplace(fluents_[i], i);
  for (std::uint32_t i = 0; i < events_.size(); ++i) event_numbers_.emplace(events_[i], i);
  const auto releasable = releasable_symbols(model);
  for (const auto fluent : fluents_) {
    releasable_.push_back(releasable[terms_[fluent].symbol.index()]);
  }
  may_hold_.assign(fluents_.size(), true);
  may_happen_.assign(events_.size(), true);
}

std::vector<bool> releasable_symbols(const TypedModel& model) {
  std::vector<bool> result(model.symbols.size(), false);
  bool all = false;
  const auto mark = [&](TermId id) {
    const auto& term = model.terms[id];
    if (term.kind == TermKind::kApply) {
      result[term.symbol.index()] = true;
    } else {
      all = true;
    }
  };
  for (std::size_t i = 0; i < model.symbols.size(); ++i) {
    const auto& symbol = model.symbols[model.symbols.id_at(i)];
    if (symbol.noninertial || symbol.manual_release) result[i] = true;
  }
  for (const auto& effect : model.effects) {
    if (effect.kind == EffectKind::kReleases) mark(effect.fluent);
  }
  for (const auto& formula : model.formulas) {
    if (formula.kind != FormulaKind::kAtom) continue;
    if (formula.predicate == model.core.released_at) mark(formula.terms[0]);
    if (formula.predicate == model.core.releases) mark(formula.terms[1]);
  }
  if (all) result.assign(result.size(), true);
  return result;
}

std::optional<std::uint32_t> GroundModel::fluent_number(GroundTermId term) const {
  const auto found = fluent_numbers_.find(term);
  if (found == fluent_numbers_.end()) return std::nullopt;
  return found->second;
}

std::optional<std::uint32_t> GroundModel::event_number(GroundTermId term) const {
  const auto found = event_numbers_.find(term);
  if (found == event_numbers_.end()) return std::nullopt;
  return found->second;
}

/// Two bits for the kind, 32 for the timepoint, 30 for the number of the fluent or event.
std::uint64_t GroundModel::timed_key(AtomKind kind, std::uint32_t index, Timepoint t) {
  PARALLAX_REQUIRE(static_cast<unsigned>(kind) < 4U && index < (1U << 30U),
                   "timed atoms are of four kinds, and fewer than 2^30 of each");
  return (static_cast<std::uint64_t>(kind) << 62U) ^
         (static_cast<std::uint64_t>(static_cast<std::uint32_t>(t)) << 30U) ^ index;
}

FormulaId GroundModel::timed(AtomKind kind, std::uint32_t index, Timepoint t) {
  const auto [entry, added] =
      timed_.try_emplace(timed_key(kind, index, t), static_cast<std::int32_t>(atoms_.size() + 1));
  if (added) atoms_.push_back({kind, index, t, kind == AtomKind::kHappens && t == horizon()});
  return formulas_.atom(entry->second);
}

FormulaId GroundModel::holds(std::uint32_t fluent, Timepoint t) {
  return timed(AtomKind::kHoldsAt, fluent, t);
}

FormulaId GroundModel::released(std::uint32_t fluent, Timepoint t) {
  if (!releasable_[fluent]) return formulas_.falsity();
  return timed(AtomKind::kReleasedAt, fluent, t);
}

FormulaId GroundModel::happens(std::uint32_t event, Timepoint t) {
  PARALLAX_REQUIRE(t < horizon(), "events happen before the last timepoint");
  return timed(AtomKind::kHappens, event, t);
}

FormulaId GroundModel::happens_last(std::uint32_t event) {
  return timed(AtomKind::kHappens, event, horizon());
}

std::optional<FormulaId> GroundModel::find_happens_last(std::uint32_t event) {
  const auto found = timed_.find(timed_key(AtomKind::kHappens, event, horizon()));
  if (found == timed_.end()) return std::nullopt;
  return formulas_.atom(found->second);
}

FormulaId GroundModel::predicate(GroundTermId term) {
  if (true_predicates_.contains(term)) return formulas_.truth();
  if (closed_.contains(terms_[term].symbol) && !predicates_.contains(term)) {
    return formulas_.falsity();
  }
  const auto [entry, added] =
      predicates_.try_emplace(term, static_cast<std::int32_t>(atoms_.size() + 1));
  if (added) atoms_.push_back({AtomKind::kPredicate, term.index(), GroundAtom::kUntimed, false});
  return formulas_.atom(entry->second);
}

FormulaId GroundModel::plan_atom(AtomKind kind, PlanAtom plan, Timepoint t) {
  const auto [entry, added] = plan_variables_.try_emplace(
      std::tuple(kind, plan, t), static_cast<std::int32_t>(atoms_.size() + 1));
  if (added) {
    atoms_.push_back({kind, static_cast<std::uint32_t>(plan_atoms_.size()), t, false});
    plan_atoms_.push_back(std::move(plan));
  }
  return formulas_.atom(entry->second);
}

FormulaId GroundModel::auxiliary_atom(Timepoint time) {
  atoms_.push_back({AtomKind::kAuxiliary, 0, time, false});
  return formulas_.atom(static_cast<std::int32_t>(atoms_.size()));
}

std::string GroundModel::atom_name(const GroundAtom& atom) const {
  switch (atom.kind) {
    case AtomKind::kHoldsAt:
    case AtomKind::kReleasedAt:
      return terms_.text(fluents_[atom.index], *typed_);
    case AtomKind::kHappens:
      return terms_.text(events_[atom.index], *typed_);
    case AtomKind::kPredicate:
      return terms_.text(GroundTermId(atom.index), *typed_);
    case AtomKind::kLocation:
    case AtomKind::kHit:
    case AtomKind::kRunning:
    case AtomKind::kSucceeded:
    case AtomKind::kResult:
    case AtomKind::kRegister:
      return to_string(atom.kind, plan_atoms_[atom.index]);
    case AtomKind::kAuxiliary:
    case AtomKind::kUnused:
      break;
  }
  return {};
}

Atom GroundModel::described(const GroundAtom& atom) const {
  Atom out;
  out.kind = atom.kind;
  if (atom.time != GroundAtom::kUntimed) out.time = atom.time;
  if (is_of_plan(atom.kind)) {
    out.plan = plan_atoms_[atom.index];
  } else {
    out.name = atom_name(atom);
  }
  return out;
}

FormulaId GroundModel::shifted(FormulaId formula, Timepoint steps) {
  if (steps == 0) return formula;
  RewriteMemo memo;
  return rewrite_atoms(
      formulas_, formula,
      [&](std::int32_t variable) {
        const auto moved = atom(variable);
        if (moved.time == GroundAtom::kUntimed) return formulas_.atom(variable);
        return timed(moved.kind, moved.index, moved.time + steps);
      },
      memo);
}

std::uint32_t GroundModel::add_origin(base::SourceRange source, OriginKind kind) {
  origins_.push_back({source, kind});
  return static_cast<std::uint32_t>(origins_.size() - 1);
}

void GroundModel::require(FormulaId formula, std::uint32_t origin) {
  if (formula == formulas_.truth()) return;
  constraints_.push_back({formula, origin, Constraint::kOnce});
}

void GroundModel::require_always(FormulaId formula, std::uint32_t origin, Timepoint width) {
  if (formula == formulas_.truth() || width > horizon()) return;
  constraints_.push_back({formula, origin, width});
}

Timepoint GroundModel::needed_horizon_of(FormulaId root) const {
  if (formulas_.kind(root) == FormulaNodeKind::kAtom) {
    return atom(formulas_.variable(root)).needed_horizon();
  }
  Timepoint latest = 0;
  for (const auto variable : atoms_of(formulas_, std::span(&root, 1))) {
    latest = std::max(latest, atom(variable).needed_horizon());
  }
  return latest;
}

void EffectRows::add_always(const EffectRow& row) {
  by_fluent_[row.fluent].push_back(static_cast<std::uint32_t>(always_.size()));
  always_.push_back(row);
}

void EffectRows::add(Timepoint t, const EffectRow& row) {
  auto& rows = single_[t];
  single_by_fluent_[{t, row.fluent}].push_back(static_cast<std::uint32_t>(rows.size()));
  rows.push_back(row);
  irregular_.insert(row.fluent);
}

FormulaId EffectRows::changed(EffectKind kind, std::uint32_t fluent, Timepoint t,
                              GroundModel& model) const {
  return changed(kind, fluent, t, model.formulas().truth(), model);
}

FormulaId EffectRows::changed(EffectKind kind, std::uint32_t fluent, Timepoint t, FormulaId given,
                              GroundModel& model) const {
  std::vector<FormulaId> triggers;
  const auto trigger = [&](const EffectRow& row, Timepoint shift) {
    if (row.kind != kind) return;
    const auto condition = where(given, model.shifted(row.condition, shift), model.formulas());
    triggers.push_back(model.formulas().conjunction(model.happens(row.event, t), condition));
  };
  for (const auto number : by_fluent_[fluent]) trigger(always_[number], t);
  const auto found = single_by_fluent_.find({t, fluent});
  if (found != single_by_fluent_.end()) {
    for (const auto number : found->second) trigger(single_.at(t)[number], 0);
  }
  return model.formulas().disjunction(std::move(triggers));
}

FormulaId EffectRows::holds(EffectKind kind, std::uint32_t event, std::uint32_t fluent, Timepoint t,
                            GroundModel& model) const {
  std::vector<FormulaId> conditions;
  for (const auto number : by_fluent_[fluent]) {
    const auto& row = always_[number];
    if (row.kind == kind && row.event == event) {
      conditions.push_back(model.shifted(row.condition, t));
    }
  }
  const auto found = single_by_fluent_.find({t, fluent});
  if (found != single_by_fluent_.end()) {
    for (const auto number : found->second) {
      const auto& row = single_.at(t)[number];
      if (row.kind == kind && row.event == event) conditions.push_back(row.condition);
    }
  }
  return model.formulas().disjunction(std::move(conditions));
}

std::string atom_text(const GroundModel& model, std::int32_t variable) {
  const auto& atom = model.atom(variable);
  if (is_nameless(atom.kind)) return "aux" + std::to_string(variable);
  if (atom.kind == AtomKind::kPredicate) return model.atom_name(atom);
  auto text = std::string(to_string(atom.kind)) + '(' + model.atom_name(atom);
  if (atom.time != GroundAtom::kUntimed) text += ',' + std::to_string(atom.time);
  return text + ')';
}

FormulaText formula_text(const GroundModel& model) {
  return {model.formulas(), [&model](std::int32_t variable) { return atom_text(model, variable); }};
}

std::string origin_text(const Origin& origin, const base::SourceFiles* files) {
  const std::string word(to_string(origin.kind));
  if (files == nullptr || origin.source.end == 0) return word;
  return files->place(origin.source) + ' ' + word;
}

std::string constraint_lines(const GroundModel& model, std::span<const Constraint> constraints,
                             FormulaText& formulas, const base::SourceFiles* files) {
  std::string out;
  for (const auto& constraint : constraints) {
    out += origin_text(model.origins()[constraint.origin], files);
    if (constraint.width != Constraint::kOnce) {
      out += " (every timepoint, width " + std::to_string(constraint.width) + ')';
    }
    out += ": " + formulas.text(constraint.formula) + '\n';
  }
  return out;
}

std::string ground_text(const GroundModel& model, const EffectRows& rows,
                        const base::SourceFiles* files) {
  auto formulas = formula_text(model);
  for (const auto& row : rows.always()) formulas.count(row.condition);
  for (const auto& [t, list] : rows.single()) {
    for (const auto& row : list) formulas.count(row.condition);
  }
  for (const auto& constraint : model.constraints()) formulas.count(constraint.formula);

  std::string out = "; fluents\n";
  for (std::uint32_t f = 0; f < model.fluents().size(); ++f) {
    out += model.terms().text(model.fluents()[f], model.typed());
    out += model.may_hold(f) ? "\n" : " never holds\n";
  }
  out += "; events\n";
  for (std::uint32_t e = 0; e < model.events().size(); ++e) {
    out += model.terms().text(model.events()[e], model.typed());
    out += model.may_happen(e) ? "\n" : " never happens\n";
  }
  out += "; effects\n";
  for (const auto& row : rows.always()) out += row_line(model, row, "time", formulas, files);
  for (const auto& [t, list] : rows.single()) {
    for (const auto& row : list) out += row_line(model, row, std::to_string(t), formulas, files);
  }
  out += "; constraints\n" + constraint_lines(model, model.constraints(), formulas, files);
  return out + "; parts\n" + formulas.definitions();
}

}  // namespace parallax::compiler
