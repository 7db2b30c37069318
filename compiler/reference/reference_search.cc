#include "compiler/reference/reference_search.h"

namespace parallax::compiler {

void ReferenceSearch::run(std::size_t limit, std::int64_t max_reasons) {
  limit_ = limit;
  if (full()) return;
  check_axioms();
  check_releases();
  const auto fluents = static_cast<std::uint32_t>(expanded_.fluents().size());
  for (std::int64_t t = 0; t < last_; ++t) {
    for (std::uint32_t f = 0; f < fluents && !full(); ++f) {
      if (!expanded_.symbol_of(f).noninertial) check_frame(f, t);
      check_effects(f, t);
    }
  }
  for (std::size_t i = 0; i < expanded_.paths().size() && !full(); ++i) check_path(i);
  if (!full()) check_completion(max_reasons);
}

ReferenceSearch::Truth ReferenceSearch::value(const ReferenceFormula& formula) const {
  if (formula.needed > last_) return Truth::kUnknown;
  return expanded_.trees().value(formula.node, values_) ? Truth::kTrue : Truth::kFalse;
}

ReferenceSearch::Truth ReferenceSearch::fires(const ExpandedModel::EffectRow& row,
                                              std::int64_t t) const {
  if (!is_true(expanded_.happens(row.event, t))) return Truth::kFalse;
  return value(row.condition);
}

ReferenceSearch::Truth ReferenceSearch::changed(EffectKind kind, std::uint32_t fluent,
                                                std::int64_t t) const {
  auto result = Truth::kFalse;
  for (const auto& row : expanded_.rows(fluent, t)) {
    if (row.kind != kind) continue;
    const auto fired = fires(row, t);
    if (fired == Truth::kTrue) return fired;
    if (fired == Truth::kUnknown) result = fired;
  }
  return result;
}

void ReferenceSearch::check_axioms() {
  const auto& conjuncts = expanded_.conjuncts();
  for (std::size_t i = 0; i < conjuncts.size() && !full(); ++i) {
    if (value(conjuncts[i].formula) != Truth::kFalse) continue;
    note({Rule::kAxiom, 0, i, 0, conjuncts[i].formula.needed});
  }
}

/// A noninertial fluent is released at all times; others are not at the start, unless the model
/// leaves that open.
void ReferenceSearch::check_releases() {
  for (std::uint32_t f = 0; f < expanded_.fluents().size() && !full(); ++f) {
    const auto& symbol = expanded_.symbol_of(f);
    for (std::int64_t t = 0; t <= last_ && symbol.noninertial; ++t) {
      if (!is_true(expanded_.released(f, t))) note({Rule::kNoninertial, 0, 0, f, t});
    }
    if (symbol.noninertial || symbol.manual_release) continue;
    if (is_true(expanded_.released(f, 0))) note({Rule::kReleasedAtStart, 0, 0, f, 0});
  }
}

void ReferenceSearch::check_frame(std::uint32_t f, std::int64_t t) {
  const bool holds = is_true(expanded_.holds(f, t));
  const bool holds_next = is_true(expanded_.holds(f, t + 1));
  const bool released = is_true(expanded_.released(f, t));
  const bool released_next = is_true(expanded_.released(f, t + 1));
  const auto untouched = [&](EffectKind kind) { return changed(kind, f, t) == Truth::kFalse; };
  const auto broken = [&](int dec) { note({Rule::kFrame, dec, 0, f, t}); };
  if (holds && !released_next && !holds_next && untouched(EffectKind::kTerminates)) broken(5);
  if (!holds && !released_next && holds_next && untouched(EffectKind::kInitiates)) broken(6);
  if (released && !released_next && untouched(EffectKind::kInitiates) &&
      untouched(EffectKind::kTerminates)) {
    broken(7);
  }
  if (!released && released_next && untouched(EffectKind::kReleases)) broken(8);
}

void ReferenceSearch::check_effects(std::uint32_t f, std::int64_t t) {
  const auto& rows = expanded_.rows(f, t);
  const bool holds_next = is_true(expanded_.holds(f, t + 1));
  const bool released_next = is_true(expanded_.released(f, t + 1));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (fires(rows[i], t) != Truth::kTrue) continue;
    const auto broken = [&](int dec) { note({Rule::kEffect, dec, i, f, t}); };
    const auto kind = rows[i].kind;
    if (kind == EffectKind::kInitiates && !holds_next) broken(9);
    if (kind == EffectKind::kTerminates && holds_next) broken(10);
    if (kind == EffectKind::kReleases && !released_next) broken(11);
    if (kind != EffectKind::kReleases && released_next) broken(12);
  }
}

/// DEC3: what initiates the fluent at `begin` starts the development, what terminates it strictly
/// before `end` stops it. DEC4: the other way round.
void ReferenceSearch::check_path(std::size_t index) {
  const auto& path = expanded_.paths()[index];
  if (path.end > last_ || is_true(expanded_.holds(path.target, path.end))) return;
  const bool forward = model_.trajectories[path.trajectory].kind == TrajectoryKind::kTrajectory;
  const auto starts = forward ? EffectKind::kInitiates : EffectKind::kTerminates;
  const auto stops = forward ? EffectKind::kTerminates : EffectKind::kInitiates;
  if (value(path.condition) != Truth::kTrue) return;
  if (changed(starts, path.fluent, path.begin) != Truth::kTrue) return;
  for (auto t = path.begin + 1; t < path.end; ++t) {
    if (changed(stops, path.fluent, t) != Truth::kFalse) return;
  }
  note({Rule::kTrajectory, forward ? 3 : 4, index, path.fluent, path.end});
}

void ReferenceSearch::check_completion(std::int64_t max_reasons) {
  const auto& all = expanded_.completed();
  std::int64_t evaluated = 0;
  Values changed;
  for (std::size_t i = 0; i < all.size() && !full(); ++i) {
    if (!is_true(all[i].atom) || expanded_.needed(all[i].atom) > last_) continue;
    for (const auto reason : all[i].reasons) evaluated += expanded_.conjuncts()[reason].size;
    if (evaluated > max_reasons) {
      finished_ = false;
      return;
    }
    if (changed.empty()) changed = values_;
    if (has_reason(all[i], changed)) continue;
    note({Rule::kCompletion, 0, i, 0, expanded_.timepoint(all[i].atom).value_or(0)});
  }
}

/// Is some axiom false where the atom is? One that needs later timepoints may be.
bool ReferenceSearch::has_reason(const ExpandedModel::Completed& completed, Values& changed) const {
  changed[completed.atom] = 0;
  bool found = false;
  for (std::size_t i = 0; i < completed.reasons.size() && !found; ++i) {
    const auto& formula = expanded_.conjuncts()[completed.reasons[i]].formula;
    found = formula.needed > last_ || !expanded_.trees().value(formula.node, changed);
  }
  changed[completed.atom] = 1;
  return found;
}

}  // namespace parallax::compiler
