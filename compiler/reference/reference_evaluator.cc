// Checks a valuation against every rule of a model, one after the other, without a solver.
//
// The model is expanded by plain instantiation (expanded_model.cc). The instances of axioms,
// DEC3 to DEC12 for each fluent and timepoint, releases and the reasons of completed atoms are
// evaluated under the valuation. A completed atom that is true has a reason if some formula
// becomes false when the atom does. A formula that needs a timepoint after the last one is
// unknown and breaks nothing.
//
// Effects that conditions mention are the alternating fixpoint (Van Gelder 1989). Where an
// effect is negated the last set found is taken for all effects: too few give a least set with
// too many, too many give one with too few, and they approach each other. If they still differ
// when nothing changes, an effect depends on its own absence, which is a finding as well.
//
// Founded atoms are derived in rounds, from none on: an axiom is a reason if it is false without
// the atom, and if completed atoms that it asks for count only where they have been derived.
//
// Cost: each formula once, and for each completed atom all that may be its reasons, within a
// limit. The fixpoint for n effects takes at most n rounds of two times n sweeps over the rows.

#include "compiler/reference/reference_evaluator.h"

#include <algorithm>
#include <map>

#include "compiler/base/contract.h"
#include "compiler/base/ground_name.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMaxAtoms = 6;  // quoted in one text

}  // namespace

/// The alternating fixpoint (Van Gelder 1989): too few effects, then too many, closer each time.
ReferenceSearch::ReferenceSearch(const TypedModel& model, const ExpandedModel& expanded,
                                 const Values& values, std::int64_t last)
    : model_(model), expanded_(expanded), values_(values), last_(last) {
  effects_.assign(expanded.effects().size(), 0);
  if (effects_.empty()) return;
  for (;;) {
    const auto most = least_effects(values, effects_);
    auto least = least_effects(values, most);
    const bool settled = least == effects_;
    effects_ = std::move(least);
    if (!settled) continue;
    circular_ = effects_ != most;
    return;
  }
}

ReferenceSearch::Values ReferenceSearch::least_effects(const Values& values,
                                                       const Values& absent) const {
  Values found(absent.size(), 0);
  for (bool grown = true; grown;) {
    grown = false;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto& effect = expanded_.effects()[i];
      if (found[i] != 0 || effect.needed > last_) continue;
      for (const auto& row : expanded_.rows(effect.fluent, effect.time)) {
        if (row.kind != effect.kind || row.event != effect.event) continue;
        const FormulaTrees::Sides sides{&values, &values_, {&found, &absent}};
        if (!expanded_.trees().sided_value(row.condition.node, sides)) continue;
        found[i] = 1;
        grown = true;
        break;
      }
    }
  }
  return found;
}

void ReferenceSearch::run(std::size_t limit, std::int64_t max_reasons) {
  limit_ = limit;
  if (full()) return;
  if (circular_) note({Rule::kCircularEffects, 0, 0, 0, 0});
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
  if (!full() && model_.options.founded) check_founded(max_reasons);
}

ReferenceSearch::Truth ReferenceSearch::value(const ReferenceFormula& formula) const {
  if (formula.needed > last_) return Truth::kUnknown;
  return expanded_.trees().value(formula.node, values_, {&effects_, &effects_}) ? Truth::kTrue
                                                                                : Truth::kFalse;
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
    found = formula.needed > last_ ||
            !expanded_.trees().value(formula.node, changed, {&effects_, &effects_});
  }
  changed[completed.atom] = 1;
  return found;
}

/// With several completions an atom needs a derivation from each.
void ReferenceSearch::check_founded(std::int64_t max_reasons) {
  const auto& all = expanded_.completed();
  Values derived = values_, changed = values_;
  std::map<std::uint32_t, std::vector<std::size_t>> open;  // by atom: its completions
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!is_true(all[i].atom) || expanded_.needed(all[i].atom) > last_) continue;
    derived[all[i].atom] = 0;
    open[all[i].atom].push_back(i);
  }
  std::int64_t evaluated = 0;
  for (bool grown = true; grown;) {
    const auto effects = least_effects(derived, effects_);
    const FormulaTrees::Sides sides{&changed, &derived, {&effects_, &effects}};
    const auto gives_reason = [&](std::size_t conjunct) {
      const auto& formula = expanded_.conjuncts()[conjunct].formula;
      evaluated += expanded_.conjuncts()[conjunct].size;
      return formula.needed > last_ || !expanded_.trees().sided_value(formula.node, sides);
    };
    grown = std::erase_if(open, [&](const auto& entry) {
              const auto& [atom, completions] = entry;
              changed[atom] = 0;
              const bool found =
                  std::all_of(completions.begin(), completions.end(), [&](std::size_t i) {
                    return std::any_of(all[i].reasons.begin(), all[i].reasons.end(), gives_reason);
                  });
              changed[atom] = 1;
              derived[atom] = found ? 1 : 0;
              return found;
            }) > 0;
    if (evaluated <= max_reasons) continue;
    finished_ = false;
    return;
  }
  for (const auto& [atom, completions] : open) {
    note({Rule::kFounded, 0, completions.front(), 0, expanded_.timepoint(atom).value_or(0)});
  }
}

std::vector<std::uint8_t> atom_values(const ExpandedModel& expanded, const Valuation& valuation) {
  std::vector<std::uint8_t> values(expanded.atom_count(), 0);
  const auto last =
      std::min(static_cast<std::int64_t>(valuation.holds.size()) - 1, expanded.horizon());
  for (std::int64_t t = 0; t <= last; ++t) {
    const auto now = static_cast<std::size_t>(t);
    for (const auto& text : valuation.holds[now]) {
      if (const auto f = expanded.fluent(text)) values[expanded.holds(*f, t)] = 1;
    }
    if (now < valuation.released.size()) {
      for (const auto& text : valuation.released[now]) {
        if (const auto f = expanded.fluent(text)) values[expanded.released(*f, t)] = 1;
      }
    }
    if (t == last || now >= valuation.happens.size()) continue;
    for (const auto& text : valuation.happens[now]) {
      if (const auto e = expanded.event(text)) values[expanded.happens(*e, t)] = 1;
    }
  }
  for (const auto& text : valuation.predicates) {
    if (const auto number = expanded.predicate(text)) values[*number] = 1;
  }
  return values;
}

ReferenceEvaluator::ReferenceEvaluator(const TypedModel& model, const ReferenceLimits& limits)
    : model_(model),
      limits_(limits),
      budget_(limits.max_instances, limits.stop),
      expanded_(model, budget_) {}

std::optional<std::string> ReferenceEvaluator::refusal() const {
  if (expanded_.too_deep()) return "its formulas nest too deep";
  if (!budget_.spent()) return std::nullopt;
  if (limits_.stop != nullptr && limits_.stop->load()) return "the check was stopped";
  return "the model has more than " + std::to_string(limits_.max_instances) +
         " ground terms and instances";
}

std::optional<Violation> ReferenceEvaluator::check(const Valuation& valuation) const {
  auto report = violations(valuation, 1);
  if (report.violations.empty()) return std::nullopt;
  return std::move(report.violations.front());
}

ReferenceReport ReferenceEvaluator::violations(const Valuation& valuation,
                                               std::size_t limit) const {
  PARALLAX_REQUIRE(!refusal(), "a model within the limits");
  ReferenceReport report;
  note_strange_atoms(valuation, limit, report.violations);
  const auto values = values_of(valuation);
  const auto length = static_cast<std::int64_t>(valuation.holds.size()) - 1;
  ReferenceSearch search(model_, expanded_, values, std::min(length, horizon()));
  search.run(limit - report.violations.size(), limits_.max_reasons);
  for (const auto& finding : search.found()) report.violations.push_back(describe(finding, values));
  report.finished = search.finished();
  return report;
}

bool ReferenceEvaluator::accepts(const Values& values) const {
  ReferenceSearch search(model_, expanded_, values, horizon());
  search.run(1, limits_.max_reasons);
  return search.found().empty();
}

std::vector<base::SourceRange> ReferenceEvaluator::silent_axioms() const {
  std::vector<base::SourceRange> sources;
  for (const auto axiom : expanded_.silent_axioms()) {
    if (model_.axioms[axiom].is_foundation) continue;
    sources.push_back(model_.axioms[axiom].source);
  }
  return sources;
}

/// Atoms that the model does not have, or that nothing could be a reason for.
void ReferenceEvaluator::note_strange_atoms(const Valuation& valuation, std::size_t limit,
                                            std::vector<Violation>& out) const {
  const auto note = [&](std::string what, std::int64_t t) {
    if (out.size() < limit) out.push_back({{}, what, t, what});
  };
  const auto scan = [&](const std::vector<std::set<std::string>>& points, const std::string& name,
                        std::int64_t last, const auto& known) {
    for (std::size_t t = 0; t < points.size(); ++t) {
      const auto time = static_cast<std::int64_t>(t);
      for (const auto& text : points[t]) {
        if (time <= last && known(text)) continue;
        note("there is no " + name + "(" + text + "," + std::to_string(t) + ")", time);
      }
    }
  };
  const auto last = static_cast<std::int64_t>(valuation.holds.size()) - 1;
  if (last < 0 || last > horizon()) {
    note(
        "the trace ends at " + std::to_string(last) + ", the model at " + std::to_string(horizon()),
        last);
  }
  const auto is_fluent = [&](const auto& text) { return expanded_.fluent(text).has_value(); };
  const auto is_event = [&](const auto& text) { return expanded_.event(text).has_value(); };
  scan(valuation.holds, "HoldsAt", horizon(), is_fluent);
  scan(valuation.released, "ReleasedAt", last, is_fluent);
  scan(valuation.happens, "Happens", last - 1, is_event);
  for (const auto& text : valuation.predicates) {
    if (expanded_.predicate(text)) continue;
    const auto symbol = model_.find_symbol(base::symbol_of(text));
    if (!symbol || model_.symbols[*symbol].kind != SymbolKind::kPredicate) {
      note("there is no " + text, 0);
      continue;
    }
    for (const auto& completion : model_.completions) {
      if (completion.predicate != *symbol) continue;
      const auto what = "completion of " + text;
      if (out.size() < limit) out.push_back({completion.source, what, 0, what + ": no reason"});
    }
  }
}

/// "HoldsAt(F(),1) is true, ..."
std::string ReferenceEvaluator::deciding_atoms(FormulaTrees::Node node,
                                               const Values& values) const {
  const auto atoms = expanded_.trees().atoms_of(node);
  std::string out;
  for (std::size_t i = 0; i < atoms.size() && i < kMaxAtoms; ++i) {
    out += (i > 0 ? ", " : "") + expanded_.atom_text(atoms[i]);
    out += values[atoms[i]] != 0 ? " is true" : " is false";
  }
  if (atoms.size() > kMaxAtoms) {
    out += " and " + std::to_string(atoms.size() - kMaxAtoms) + " more";
  }
  return out.empty() ? "false whatever happens" : out;
}

Violation ReferenceEvaluator::describe(const ReferenceFinding& finding,
                                       const Values& values) const {
  using Rule = ReferenceFinding::Rule;
  const auto t = finding.timepoint;
  const auto at = [&](const std::string& what) { return what + " at " + std::to_string(t); };
  const auto dec = [&] {
    return "DEC" + std::to_string(finding.dec) + " for " + expanded_.fluents()[finding.fluent];
  };
  const auto fluent_source = [&] { return expanded_.symbol_of(finding.fluent).declared; };
  const auto& fluents = expanded_.fluents();
  switch (finding.rule) {
    case Rule::kAxiom: {
      const auto& conjunct = expanded_.conjuncts()[finding.index];
      return {model_.axioms[conjunct.axiom].source, "axiom", t,
              "axiom: " + deciding_atoms(conjunct.formula.node, values)};
    }
    case Rule::kNoninertial: {
      const auto what = "noninertial " + fluents[finding.fluent];
      return {fluent_source(), what, t, at(what + ": not released")};
    }
    case Rule::kReleasedAtStart: {
      const auto what = "released at the start: " + fluents[finding.fluent];
      return {fluent_source(), what, t, what};
    }
    case Rule::kFrame:
      return {fluent_source(), dec(), t,
              at(dec() + ": " + (finding.dec <= 6 ? "it" : "its release") +
                 " changes without an event")};
    case Rule::kEffect: {
      const auto& row = expanded_.rows(finding.fluent, t)[finding.index];
      return {model_.effects[row.effect].source, dec(), t,
              dec() + ": no effect of Happens(" + expanded_.events()[row.event] + "," +
                  std::to_string(t) + ")"};
    }
    case Rule::kTrajectory: {
      const auto& path = expanded_.paths()[finding.index];
      return {model_.trajectories[path.trajectory].source, dec(), t,
              dec() + ": since " + std::to_string(path.begin) + " it leads to HoldsAt(" +
                  fluents[path.target] + "," + std::to_string(path.end) + ")"};
    }
    case Rule::kCompletion:
    case Rule::kFounded: {
      const auto& completed = expanded_.completed()[finding.index];
      const auto what = "completion of " + expanded_.atom_text(completed.atom);
      const auto* why =
          finding.rule == Rule::kFounded ? ": only reasons in a circle" : ": no reason";
      return {model_.completions[completed.completion].source, what, t, what + why};
    }
    case Rule::kCircularEffects: {
      const std::string what = "effects depend on their own absence";
      return {model_.effects.front().source, what, t, what};
    }
  }
  return {};
}

}  // namespace parallax::compiler
