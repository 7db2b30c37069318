// Effect axioms as rows, and the frame problem over the rows (DEC3 to DEC12 of Mueller 2006).
//
// A row says that an event under a condition initiates, terminates or releases a fluent.
// Circumscription makes Initiates, Terminates and Releases the disjunction of their rows, so
// these predicates never become atoms, and the frame axioms of a fluent mention only events that
// can touch it. An axiom that says the same at every timepoint gives rows once, at timepoint 0;
// if all rows of a fluent are such, its frame axioms are written once as well.
//
// Trajectories run from the event that starts their fluent to the first one that stops it. One
// auxiliary for each pair of timepoints means "still running", defined by the one before, so no
// clause grows with the distance.
//
// Cost: linear in the rows, times the horizon for fluents without a template; quadratic in the
// horizon for trajectories.

#include "compiler/ground/effects.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

#include "compiler/base/codes/grounding.h"
#include "compiler/ground/meetings.h"
#include "compiler/ground/time_profile.h"

namespace parallax::compiler {
namespace {

/// Writes the axioms of each fluent once for all timepoints, or timepoint by timepoint if some
/// event changes it at single timepoints only.
class InertiaWriter {
 public:
  InertiaWriter(GroundModel& model, const EffectRows& rows, const GroundOptions& options)
      : model_(model),
        rows_(rows),
        templates_(options.meaning == Meaning::kStandard && options.templates),
        short_(drops_meetings(model, options)) {
    const auto& symbols = model.typed().symbols;
    // With encoding 3 the 2005 reasoner writes the axioms for inertial fluents, or for all if there
    // are none.
    frames_of_noninertial_ = options.meaning == Meaning::kDecreasoner &&
                             model.typed().options.encoding == 3 &&
                             std::all_of(symbols.begin(), symbols.end(), [](const Symbol& symbol) {
                               return symbol.kind != SymbolKind::kFluent || symbol.noninertial;
                             });
    for (std::size_t i = 0; i < symbols.size(); ++i) {
      const auto& symbol = symbols[symbols.id_at(i)];
      origins_.push_back(symbol.kind == SymbolKind::kFluent
                             ? model.add_origin(symbol.declared, OriginKind::kFrameAxiom)
                             : 0);
    }
  }

  void write() {
    if (model_.horizon() > 0) {
      for (const auto& row : rows_.always()) assert_effect(row, 0, true);
    }
    for (const auto& [t, rows] : rows_.single()) {
      for (const auto& row : rows) assert_effect(row, t, false);
    }
    for (std::uint32_t f = 0; f < model_.fluents().size(); ++f) {
      if (!model_.may_hold(f) && !model_.can_be_released(f)) continue;
      assert_start(f);
      const bool framed = !model_.fluent_symbol(f).noninertial || frames_of_noninertial_;
      if (!framed || model_.horizon() == 0) continue;
      if (templates_ && rows_.is_uniform(f)) {
        assert_frame(f, 0, true);
        continue;
      }
      for (Timepoint t = 0; t < model_.horizon(); ++t) assert_frame(f, t, false);
    }
  }

 private:
  std::uint32_t origin_of(std::uint32_t fluent) const {
    return origins_[model_.terms()[model_.fluents()[fluent]].symbol.index()];
  }
  void require(FormulaId formula, std::uint32_t origin, bool always) {
    if (!always) return model_.require(formula, origin);
    if (templates_) return model_.require_always(formula, origin, 1);
    for (Timepoint t = 0; t < model_.horizon(); ++t) {
      model_.require(model_.shifted(formula, t), origin);
    }
  }

  /// Inertia holds from the start unless the model says otherwise; a noninertial fluent is released
  /// at every timepoint.
  void assert_start(std::uint32_t fluent) {
    const auto& symbol = model_.fluent_symbol(fluent);
    const auto origin = origin_of(fluent);
    const auto released = model_.released(fluent, 0);
    if (symbol.noninertial && templates_) {
      model_.require_always(released, origin, 0);
    } else if (symbol.noninertial) {
      for (Timepoint t = 0; t <= model_.horizon(); ++t) {
        model_.require(model_.released(fluent, t), origin);
      }
    } else if (!symbol.manual_release) {
      model_.require(~released, origin);
    }
  }

  /// DEC9 to DEC12.
  void assert_effect(const EffectRow& row, Timepoint t, bool always) {
    auto& formulas = model_.formulas();
    const auto trigger = formulas.conjunction(model_.happens(row.event, t), row.condition);
    const auto released = model_.released(row.fluent, t + 1);
    if (row.kind == EffectKind::kReleases) {
      require(formulas.implication(trigger, released), row.origin, always);
      return;
    }
    const auto after = model_.holds(row.fluent, t + 1);
    const bool up = row.kind == EffectKind::kInitiates;
    require(formulas.implication(trigger, up ? after : ~after), row.origin, always);
    require(formulas.implication(trigger, ~released), row.origin, always);
  }

  /// DEC5 to DEC8: nothing changes unless a row says so.
  void assert_frame(std::uint32_t f, Timepoint t, bool always) {
    auto& formulas = model_.formulas();
    const auto origin = origin_of(f);
    const auto changed = [&](EffectKind kind, FormulaId given) {
      return rows_.changed(kind, f, t, short_ ? given : formulas.truth(), model_);
    };
    const auto releases = rows_.changed(EffectKind::kReleases, f, t, model_);
    const auto before = model_.holds(f, t);
    const auto after = model_.holds(f, t + 1);
    const auto released_before = model_.released(f, t);
    const auto released_after = model_.released(f, t + 1);
    const bool begins = !rows_.is_lost(EffectKind::kInitiates, f, t);
    const bool ends = !rows_.is_lost(EffectKind::kTerminates, f, t);
    // Beside `before` a trigger need not ask for it again: then it is no part with a name.
    if (ends) {
      const auto terminated = changed(EffectKind::kTerminates, before);
      require(formulas.disjunction({~before, after, released_after, terminated}), origin, always);
    }
    if (begins) {
      const auto initiated = changed(EffectKind::kInitiates, ~before);
      require(formulas.disjunction({before, ~after, released_after, initiated}), origin, always);
    }
    if (begins && ends && released_before != formulas.falsity()) {
      const auto initiated = changed(EffectKind::kInitiates, formulas.truth());
      const auto terminated = changed(EffectKind::kTerminates, formulas.truth());
      require(formulas.disjunction({~released_before, released_after, initiated, terminated}),
              origin, always);
    }
    if (!rows_.is_lost(EffectKind::kReleases, f, t)) {
      require(formulas.disjunction({released_before, ~released_after, releases}), origin, always);
    }
  }

  GroundModel& model_;
  const EffectRows& rows_;
  bool templates_;
  bool short_;  // conditions that hold anyway are left out of frame axioms
  bool frames_of_noninertial_ = false;
  std::vector<std::uint32_t> origins_;  // by symbol
};

class TrajectoryWriter {
 public:
  TrajectoryWriter(GroundModel& model, const EffectRows& rows, FormulaGrounder& grounder)
      : model_(model),
        rows_(rows),
        grounder_(grounder),
        encoding2_(grounder.terms().options().meaning == Meaning::kDecreasoner &&
                   model.typed().options.encoding != 3) {}

  void write(const TrajectoryAxiom& axiom) {
    origin_ = model_.add_origin(axiom.source, OriginKind::kTrajectoryAxiom);
    grounder_.start(axiom.source);
    chains_.clear();
    const auto found =
        grounder_.instances(axiom.variables, conjuncts_of(model_.typed(), axiom.condition, false));
    const auto width = axiom.variables.size();
    const auto count = width == 0 ? 1 : found.size() / width;
    for (std::size_t i = 0; i < count && grounder_.spend(1); ++i) {
      for (std::size_t k = 0; k < width; ++k) {
        grounder_.bind(axiom.variables[k], found[i * width + k]);
      }
      instance(axiom);
    }
    for (const auto variable : axiom.variables) grounder_.unbind(variable);
  }

 private:
  void instance(const TrajectoryAxiom& axiom) {
    const auto& terms = model_.terms();
    const auto fluent = grounder_.term(axiom.fluent);
    const auto target = grounder_.term(axiom.target);
    const auto time = grounder_.term(axiom.time);
    const auto offset = grounder_.term(axiom.offset);
    if (!fluent || !target || !time || !offset) return;
    const auto f1 = model_.fluent_number(*fluent);
    const auto f2 = model_.fluent_number(*target);
    if (!f1 || !f2) return;
    const auto t = terms[*time].integer;
    const auto d = terms[*offset].integer;
    // Encoding 2 of the 2005 reasoner lets a trajectory begin with the event or before it.
    if (t < 0 || t >= model_.horizon() || (d <= 0 && !encoding2_) || d > model_.horizon() ||
        d < -model_.horizon() || t + d > model_.horizon() || t + d < 0) {
      return;
    }
    const auto condition = grounder_.ground(axiom.condition);
    if (!condition) return;
    const auto end = static_cast<Timepoint>(t + d);
    auto& formulas = model_.formulas();
    const auto premise =
        formulas.conjunction(*condition, running(axiom.kind, *f1, static_cast<Timepoint>(t), end));
    model_.require(formulas.implication(premise, model_.holds(*f2, end)), origin_);
  }

  /// Some event at `begin` starts the fluent and none strictly between `begin` and `end` stops it
  /// (DEC1 to DEC4): an atom for every pair of timepoints, so that no clause grows with their
  /// distance. It is implied by its meaning, which is all that a premise needs.
  FormulaId running(TrajectoryKind kind, std::uint32_t fluent, Timepoint begin, Timepoint end) {
    const bool forward = kind == TrajectoryKind::kTrajectory;
    const auto starts = forward ? EffectKind::kInitiates : EffectKind::kTerminates;
    const auto stops = forward ? EffectKind::kTerminates : EffectKind::kInitiates;
    if (rows_.is_lost(starts, fluent, begin)) return model_.formulas().falsity();
    auto& chain = chains_[{kind, fluent, begin}];
    auto& formulas = model_.formulas();
    if (chain.empty()) chain.push_back(rows_.changed(starts, fluent, begin, model_));
    // chain[k]: running until begin + 1 + k.
    while (static_cast<Timepoint>(chain.size()) < end - begin) {
      const auto last = begin + static_cast<Timepoint>(chain.size());
      if (chain.back() == formulas.falsity()) return formulas.falsity();
      const auto stopped = rows_.is_lost(stops, fluent, last)
                               ? formulas.falsity()
                               : rows_.changed(stops, fluent, last, model_);
      const auto goes_on = formulas.conjunction(chain.back(), ~stopped);
      if (formulas.kind(goes_on) == FormulaNodeKind::kAnd && !goes_on.negated()) {
        const auto next = model_.auxiliary_atom(last + 1);
        model_.require(formulas.implication(goes_on, next), origin_);
        chain.push_back(next);
      } else {
        chain.push_back(goes_on);
      }
    }
    return chain[static_cast<std::size_t>(std::max(end - begin, 1)) - 1];
  }

  GroundModel& model_;
  const EffectRows& rows_;
  FormulaGrounder& grounder_;
  bool encoding2_;
  std::uint32_t origin_ = 0;
  std::map<std::tuple<TrajectoryKind, std::uint32_t, Timepoint>, std::vector<FormulaId>> chains_;
};

}  // namespace

EffectGrounder::EffectGrounder(GroundModel& model, FormulaGrounder& grounder, EffectRows& rows)
    : model_(model), grounder_(grounder), rows_(&rows) {
  for (const auto& effect : model.typed().effects) {
    origins_.push_back(model.add_origin(effect.source, OriginKind::kEffectAxiom));
  }
}

std::uint32_t EffectGrounder::origin_of(const EffectAxiom& effect) {
  return origins_[static_cast<std::size_t>(&effect - model_.typed().effects.data())];
}

bool EffectGrounder::is_scheduled(const EffectAxiom& effect) const {
  const auto* possible = grounder_.possible();
  if (possible == nullptr) return false;
  const auto& event = model_.typed().terms[effect.event];
  return event.kind == TermKind::kApply ? possible->is_scheduled(event.symbol)
                                        : possible->all_events_scheduled();
}

void EffectGrounder::ground(const EffectAxiom& effect) {
  grounder_.start(effect.source);
  if (model_.horizon() == 0) return;
  const auto profile = time_profile(model_.typed(), effect);
  const auto& options = grounder_.terms().options();
  const bool always = profile.shape == TimeShape::kUniform && options.templates &&
                      options.meaning == Meaning::kStandard && !is_scheduled(effect);
  if (options.meaning == Meaning::kDecreasoner) find_lost(effect);
  if (!always) return run(effect, false);
  auto* possible = grounder_.possible();
  if (possible != nullptr) possible->set_timeless(true);
  grounder_.bind(profile.variable, model_.terms().integer(0));
  run(effect, true);
  grounder_.unbind(profile.variable);
  if (possible != nullptr) possible->set_timeless(false);
}

void EffectGrounder::ground_at(const EffectAxiom& effect, Timepoint t) {
  grounder_.start(effect.source);
  const auto& time = model_.typed().terms[effect.time];
  if (time.kind == TermKind::kVariable) {
    grounder_.bind(time.variable, model_.terms().integer(t));
    run(effect, false);
    grounder_.unbind(time.variable);
  } else {
    only_ = t;
    run(effect, false);
    only_.reset();
  }
}

void EffectGrounder::run(const EffectAxiom& effect, bool always) {
  auto conjuncts = conjuncts_of(model_.typed(), effect.condition, false);
  conjuncts.push_back({Conjunct::Kind::kEvent, {}, false, effect.event, effect.time, false});
  conjuncts.push_back({Conjunct::Kind::kFluent, {}, false, effect.fluent, effect.time, false});
  std::vector<VariableId> open;
  for (const auto variable : effect.variables) {
    if (!grounder_.terms().is_bound(variable)) open.push_back(variable);
  }
  const auto found = grounder_.instances(open, conjuncts);
  const auto count = open.empty() ? 1 : found.size() / open.size();
  for (std::size_t i = 0; i < count && grounder_.spend(1); ++i) {
    for (std::size_t k = 0; k < open.size(); ++k) {
      grounder_.bind(open[k], found[i * open.size() + k]);
    }
    instance(effect, always);
  }
  for (const auto variable : open) grounder_.unbind(variable);
}

void EffectGrounder::instance(const EffectAxiom& effect, bool always) {
  const auto time = grounder_.term(effect.time);
  const auto event = grounder_.term(effect.event);
  const auto fluent = grounder_.term(effect.fluent);
  if (!time || !event || !fluent) return;
  const auto t = model_.terms()[*time].integer;
  if (t < 0 || t >= model_.horizon() || (only_ && t != *only_)) return;
  const auto e = model_.event_number(*event);
  const auto f = model_.fluent_number(*fluent);
  if (!e || !f || !model_.may_happen(*e)) return;
  if (is_ignored(*f)) return;
  const auto condition = grounder_.ground(effect.condition);
  if (!condition || *condition == model_.formulas().falsity()) return;
  const EffectRow row{effect.kind, *e, *f, *condition, origin_of(effect)};
  if (always) {
    rows_->add_always(row);
  } else {
    rows_->add(static_cast<Timepoint>(t), row);
  }
}

/// Encoding 3 of the 2005 reasoner knows no effects on noninertial fluents.
bool EffectGrounder::is_ignored(std::uint32_t fluent) const {
  return grounder_.terms().options().meaning == Meaning::kDecreasoner &&
         model_.typed().options.encoding == 3 && model_.fluent_symbol(fluent).noninertial;
}

/// The 2005 reasoner writes an axiom whose variables are all those of the fluent and the time into
/// the fluent's frame axiom without a quantifier around it: an instance that names something that
/// does not exist takes the frame axiom with it.
void EffectGrounder::find_lost(const EffectAxiom& effect) {
  const auto& typed = model_.typed();
  const auto& time = typed.terms[effect.time];
  const auto& fluent = typed.terms[effect.fluent];
  const auto& event = typed.terms[effect.event];
  // The 2005 program does not see effects inside conjunctions (W2001).
  if (effect.shares_instances || time.kind != TermKind::kVariable ||
      fluent.kind != TermKind::kApply || event.kind != TermKind::kApply) {
    return;
  }
  std::vector<VariableId> own;
  for (const auto argument : fluent.arguments) {
    if (typed.terms[argument].kind != TermKind::kVariable) return;
    own.push_back(typed.terms[argument].variable);
  }
  const auto known = [&](VariableId variable) {
    return variable == time.variable || std::find(own.begin(), own.end(), variable) != own.end();
  };
  auto used = variables_of(typed, effect.event);
  const auto of_condition = variables_of(typed, effect.condition);
  used.insert(used.end(), of_condition.begin(), of_condition.end());
  const bool all_known = std::all_of(effect.variables.begin(), effect.variables.end(), [&](auto v) {
    return known(v) || std::find(used.begin(), used.end(), v) == used.end();
  });
  if (!all_known) return;
  std::vector<std::size_t> odometer(own.size(), 0);
  const auto domain = [&](std::size_t i) -> const std::vector<GroundTermId>& {
    return model_.universe().domain(typed.variables[own[i]].sort);
  };
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (domain(i).empty()) return;
  }
  for (bool more = true; more && grounder_.spend(1);) {
    for (std::size_t i = 0; i < own.size(); ++i) grounder_.bind(own[i], domain(i)[odometer[i]]);
    for (Timepoint t = 0; t < model_.horizon() && !grounder_.failed(); ++t) {
      grounder_.bind(time.variable, model_.terms().integer(t));
      check_lost(effect, t);
    }
    more = false;
    for (std::size_t i = own.size(); i-- > 0 && !more;) {
      more = ++odometer[i] < domain(i).size();
      if (!more) odometer[i] = 0;
    }
  }
  for (const auto variable : own) grounder_.unbind(variable);
  grounder_.unbind(time.variable);
}

void EffectGrounder::check_lost(const EffectAxiom& effect, Timepoint t) {
  const auto fluent = grounder_.term(effect.fluent);
  const auto number = fluent ? model_.fluent_number(*fluent) : std::nullopt;
  if (!number) return;
  const auto condition = grounder_.ground(effect.condition);
  if (condition && *condition == model_.formulas().falsity()) return;
  const auto event = grounder_.term(effect.event);
  if (condition && event && model_.event_number(*event)) return;
  rows_->lose(effect.kind, *number, t);
}

void assert_inertia(GroundModel& model, const EffectRows& rows, const GroundOptions& options) {
  InertiaWriter(model, rows, options).write();
}

void assert_trajectories(GroundModel& model, const EffectRows& rows, FormulaGrounder& grounder,
                         base::DiagnosticSink& sink) {
  TrajectoryWriter writer(model, rows, grounder);
  const auto& options = model.typed().options;
  const bool old = grounder.terms().options().meaning == Meaning::kDecreasoner;
  for (const auto& axiom : model.typed().trajectories) {
    if (old && options.encoding == 3 && !options.trajectory) {
      sink.warning(codes::kAxiomDropped, axiom.source,
                   "encoding 3 knows trajectories with `option trajectory on`");
      continue;
    }
    if (old && options.encoding != 3 && axiom.kind == TrajectoryKind::kAntiTrajectory) {
      sink.warning(codes::kAxiomDropped, axiom.source, "encoding 2 knows no antitrajectories");
      continue;
    }
    writer.write(axiom);
    if (grounder.failed()) return;
  }
}

}  // namespace parallax::compiler
