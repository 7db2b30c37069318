#include "compiler/ground/ground_model.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

#include "compiler/formula/atoms.h"

namespace parallax::compiler {

GroundModel::GroundModel(const TypedModel& model, GroundTermStore terms, Universe universe)
    : typed_(&model), terms_(std::move(terms)), universe_(std::move(universe)) {
  if (model.core.fluent) fluents_ = universe_.domain(*model.core.fluent);
  if (model.core.event) events_ = universe_.domain(*model.core.event);
  for (std::uint32_t i = 0; i < fluents_.size(); ++i) fluent_numbers_.emplace(fluents_[i], i);
  for (std::uint32_t i = 0; i < events_.size(); ++i) event_numbers_.emplace(events_[i], i);
  const auto releasable = releasable_symbols();
  for (const auto fluent : fluents_) {
    if (releasable[terms_[fluent].symbol.index()]) {
      release_slot_.push_back(release_count_++);
    } else {
      release_slot_.push_back(std::nullopt);
    }
  }
  allocate_timed_atoms();
}

/// A fluent symbol needs ReleasedAt atoms if an axiom can release it, if it has no inertia, if its
/// release is left open, or if some axiom speaks of ReleasedAt (about a variable fluent: all).
std::vector<bool> GroundModel::releasable_symbols() const {
  std::vector<bool> result(typed_->symbols.size(), false);
  bool all = false;
  const auto mark = [&](TermId id) {
    const auto& term = typed_->terms[id];
    if (term.kind == TermKind::kApply) {
      result[term.symbol.index()] = true;
    } else {
      all = true;
    }
  };
  for (std::size_t i = 0; i < typed_->symbols.size(); ++i) {
    const auto& symbol = typed_->symbols[typed_->symbols.id_at(i)];
    if (symbol.noninertial || symbol.manual_release) result[i] = true;
  }
  for (const auto& effect : typed_->effects) {
    if (effect.kind == EffectKind::kReleases) mark(effect.fluent);
  }
  for (const auto& formula : typed_->formulas) {
    if (formula.kind == FormulaKind::kAtom && formula.predicate == typed_->core.released_at) {
      mark(formula.terms[0]);
    }
  }
  if (all) result.assign(result.size(), true);
  return result;
}

void GroundModel::allocate_timed_atoms() {
  for (Timepoint t = 0; t <= horizon(); ++t) {
    for (const auto fluent : fluents_) {
      atoms_.push_back({AtomKind::kHoldsAt, terms_.text(fluent, *typed_), t});
    }
    for (std::size_t i = 0; i < fluents_.size(); ++i) {
      if (release_slot_[i]) {
        atoms_.push_back({AtomKind::kReleasedAt, terms_.text(fluents_[i], *typed_), t});
      }
    }
    if (t == horizon()) continue;
    for (const auto event : events_) {
      atoms_.push_back({AtomKind::kHappens, terms_.text(event, *typed_), t});
    }
  }
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

FormulaId GroundModel::holds(std::uint32_t fluent, Timepoint t) {
  const auto stride = fluents_.size() + release_count_ + events_.size();
  return formulas_.atom(
      static_cast<std::int32_t>(static_cast<std::size_t>(t) * stride + fluent + 1));
}

FormulaId GroundModel::released(std::uint32_t fluent, Timepoint t) {
  const auto slot = release_slot_[fluent];
  if (!slot) return formulas_.falsity();
  const auto stride = fluents_.size() + release_count_ + events_.size();
  return formulas_.atom(static_cast<std::int32_t>(static_cast<std::size_t>(t) * stride +
                                                  fluents_.size() + *slot + 1));
}

FormulaId GroundModel::happens(std::uint32_t event, Timepoint t) {
  PARALLAX_REQUIRE(t < horizon(), "events happen before the last timepoint");
  const auto stride = fluents_.size() + release_count_ + events_.size();
  return formulas_.atom(static_cast<std::int32_t>(static_cast<std::size_t>(t) * stride +
                                                  fluents_.size() + release_count_ + event + 1));
}

FormulaId GroundModel::named_atom(AtomKind kind, std::string name, std::optional<Timepoint> time) {
  const auto key = std::tuple(kind, name, time.value_or(-1));
  const auto found = named_.find(key);
  if (found != named_.end()) return formulas_.atom(found->second);
  atoms_.push_back({kind, std::move(name), time});
  const auto variable = static_cast<std::int32_t>(atoms_.size());
  named_.emplace(key, variable);
  return formulas_.atom(variable);
}

std::uint32_t GroundModel::add_origin(base::SourceRange source, std::string what) {
  origins_.push_back({source, std::move(what)});
  return static_cast<std::uint32_t>(origins_.size() - 1);
}

void GroundModel::require(FormulaId formula, std::uint32_t origin) {
  if (formula == formulas_.truth()) return;
  constraints_.push_back({formula, origin});
}

Timepoint GroundModel::needed_horizon_of(FormulaId root) const {
  Timepoint latest = 0;
  for (const auto variable : atoms_of(formulas_, std::span(&root, 1))) {
    latest = std::max(latest, needed_horizon(atoms_[static_cast<std::size_t>(variable) - 1]));
  }
  return latest;
}

}  // namespace parallax::compiler
