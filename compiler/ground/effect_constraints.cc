// Effect axioms whose conditions mention effects (Mueller 2006, section 6.4.1).
//
// The effects are the least ones that all effect axioms admit. While the axioms are grounded
// each effect that a condition mentions is an atom, an unknown of its own; afterwards the
// unknown is defined as the disjunction of the conditions that bring the effect about, and the
// least solution (least_fixpoint.cc) takes the place of the atoms, so that rows are rows as all
// others. A cycle through a negation shows in these atoms because formulas are not simplified by
// what they say of them. With joins, possible effects are found in rounds: each grounds the
// axioms against the effects known to be possible before, until a round finds no more.
//
// If every effect means the same at all timepoints, the system is solved for timepoint 0 alone.
// Cost: the rounds' groundings, and the fixpoint, whose new formulas are limited.

#include "compiler/ground/effect_constraints.h"

#include <algorithm>
#include <string>

#include "compiler/base/codes/grounding.h"

namespace parallax::compiler {

EffectConstraints::EffectConstraints(GroundModel& model, FormulaGrounder& grounder,
                                     EffectGrounder& effects, EffectRows& rows,
                                     PossibleAtoms* possible, base::DiagnosticSink& sink)
    : model_(model),
      grounder_(grounder),
      effects_(effects),
      rows_(rows),
      possible_(possible),
      sink_(sink) {}

/// With bounds, possible effects are found in rounds: each joins the conditions with the effects
/// known to be possible before.
void EffectConstraints::ground(const std::vector<const EffectAxiom*>& axioms) {
  grounder_.use_effect_atoms(
      [this](EffectKind kind, std::uint32_t event, std::uint32_t fluent, Timepoint t) {
        return atom({kind, event, fluent, t});
      });
  if (possible_ != nullptr) {
    possible_->know_effects();
    note_possible(rows_);
  }
  EffectRows found(model_.fluents().size());
  for (bool grown = true, fine = true; grown && fine;) {
    found = EffectRows(model_.fluents().size());
    effects_.write_to(found);
    for (const auto* axiom : axioms) {
      if (!fine) break;
      effects_.ground(*axiom);
      fine = !grounder_.failed();
    }
    grown = fine && possible_ != nullptr && note_possible(found);
  }
  effects_.write_to(rows_);
  grounder_.use_effect_atoms(nullptr);
  if (grounder_.failed()) return;
  uniform_ = is_uniform(found);
  expand(found);
  const auto limit = grounder_.terms().options().max_instances;
  const auto result = least_fixpoint(model_.formulas(), system(), static_cast<std::size_t>(limit));
  if (const auto* solution = std::get_if<std::vector<FormulaId>>(&result)) {
    write(*solution);
  } else if (const auto* cycle = std::get_if<FixpointCycle>(&result)) {
    report(*cycle);
  } else {
    sink_.error(codes::kTooManyInstances, axioms.front()->source, limit);
  }
}

FormulaId EffectConstraints::atom(const EffectKey& key) {
  const auto [entry, added] = numbers_.try_emplace(key, keys_.size());
  if (added) keys_.push_back(key);
  const auto made = model_.auxiliary_atom(key.time);
  number_of_variable_.emplace(model_.formulas().variable(made), entry->second);
  return made;
}

bool EffectConstraints::note_possible(const EffectRow& row) {
  return possible_->add_effect(row.kind, row.event, row.fluent);
}

bool EffectConstraints::note_possible(const EffectRows& rows) {
  bool grown = false;
  for (const auto& row : rows.always()) grown = note_possible(row) || grown;
  for (const auto& [t, list] : rows.single()) {
    for (const auto& row : list) grown = note_possible(row) || grown;
  }
  return grown;
}

/// Can the effects of timepoint 0 stand for those of all?
bool EffectConstraints::is_uniform(const EffectRows& found) const {
  if (!found.single().empty()) return false;
  return std::all_of(keys_.begin(), keys_.end(),
                     [&](const EffectKey& key) { return rows_.is_uniform(key.fluent); });
}

void EffectConstraints::expand(const EffectRows& found) {
  const auto add = [&](const EffectRow& row, Timepoint t) {
    pending_by_key_[{row.kind, row.event, row.fluent, t}].push_back(pending_.size());
    pending_.push_back({t, row});
  };
  const auto last = uniform_ ? 1 : model_.horizon();
  for (const auto& row : found.always()) {
    for (Timepoint t = 0; t < last; ++t) {
      auto copy = row;
      copy.condition = moved(row.condition, t);
      add(copy, t);
    }
  }
  for (const auto& [t, list] : found.single()) {
    for (const auto& row : list) add(row, t);
  }
}

/// An effect in it moves as well.
FormulaId EffectConstraints::moved(FormulaId condition, Timepoint steps) {
  if (steps == 0) return condition;
  auto& formulas = model_.formulas();
  RewriteMemo memo;
  return rewrite_atoms(
      formulas, condition,
      [&](std::int32_t variable) {
        const auto found = number_of_variable_.find(variable);
        if (found == number_of_variable_.end()) {
          return model_.shifted(formulas.atom(variable), steps);
        }
        auto key = keys_[found->second];
        key.time += steps;
        return atom(key);
      },
      memo);
}

/// Every effect that some condition mentions, and what makes it so.
FixpointSystem EffectConstraints::system() {
  FixpointSystem system{number_of_variable_, {}};
  for (const auto& key : keys_) {
    std::vector<FormulaId> ways = {rows_.holds(key.kind, key.event, key.fluent, key.time, model_)};
    if (const auto found = pending_by_key_.find(key); found != pending_by_key_.end()) {
      for (const auto number : found->second) ways.push_back(pending_[number].row.condition);
    }
    system.definitions.push_back(model_.formulas().disjunction(std::move(ways)));
  }
  return system;
}

void EffectConstraints::write(const std::vector<FormulaId>& solution) {
  auto& formulas = model_.formulas();
  RewriteMemo memo;
  for (auto& [t, row] : pending_) {
    row.condition = rewrite_atoms(
        formulas, row.condition,
        [&](std::int32_t variable) {
          const auto found = number_of_variable_.find(variable);
          return found == number_of_variable_.end() ? formulas.atom(variable)
                                                    : solution[found->second];
        },
        memo);
    if (row.condition == formulas.falsity()) continue;
    if (uniform_) {
      rows_.add_always(row);
    } else {
      rows_.add(t, row);
    }
  }
}

std::string EffectConstraints::text(const EffectKey& key) const {
  const auto name = [&](GroundTermId term) { return model_.terms().text(term, model_.typed()); };
  return std::string(effect_word(key.kind)) + '(' + name(model_.events()[key.event]) + ',' +
         name(model_.fluents()[key.fluent]) + ',' +
         (uniform_ ? std::string("time") : std::to_string(key.time)) + ')';
}

base::SourceRange EffectConstraints::source_of(const EffectKey& key, std::size_t needed,
                                               bool negated) const {
  for (const auto number : pending_by_key_.at(key)) {
    const auto& row = pending_[number].row;
    const auto atoms = positive_atoms(model_.formulas(), negated ? ~row.condition : row.condition);
    const auto stands_for = [&](std::int32_t variable) {
      const auto found = number_of_variable_.find(variable);
      return found != number_of_variable_.end() && found->second == needed;
    };
    if (std::any_of(atoms.begin(), atoms.end(), stands_for)) {
      return model_.origins()[row.origin].source;
    }
  }
  return {};
}

void EffectConstraints::report(const FixpointCycle& cycle) const {
  constexpr std::size_t kMostSteps = 8;
  std::string path = "`" + text(keys_[cycle.path[0].unknown]);
  std::vector<base::SourceRange> sources;
  for (std::size_t i = 0; i < cycle.path.size(); ++i) {
    const auto& step = cycle.path[i];
    const auto next = cycle.path[(i + 1) % cycle.path.size()].unknown;
    sources.push_back(source_of(keys_[step.unknown], next, step.negated));
    if (i == kMostSteps) path += " <- ...";
    if (i >= kMostSteps && i + 1 < cycle.path.size()) continue;
    path += " <- " + std::string(step.negated ? "!" : "") + text(keys_[next]);
  }
  auto error = sink_.error(codes::kEffectCycle, sources[0], path + "`");
  for (std::size_t i = 1; i < sources.size() && i < kMostSteps; ++i) {
    const bool noted = std::find(sources.begin(), sources.begin() + static_cast<std::ptrdiff_t>(i),
                                 sources[i]) != sources.begin() + static_cast<std::ptrdiff_t>(i);
    if (!noted) error.note(sources[i], "the cycle goes through this axiom");
  }
}

}  // namespace parallax::compiler
