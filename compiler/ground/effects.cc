#include "compiler/ground/effects.h"

#include "compiler/ground/time_profile.h"

namespace parallax::compiler {

EffectGrounder::EffectGrounder(GroundModel& model, FormulaGrounder& grounder, EffectRows& rows)
    : model_(model), grounder_(grounder), rows_(rows) {
  for (const auto& effect : model.typed().effects) {
    origins_.push_back(model.add_origin(effect.source, "effect axiom"));
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
  // Encoding 3 of the 2005 reasoner has no axioms for a noninertial fluent but those of releases.
  if (grounder_.terms().options().meaning == Meaning::kDecreasoner &&
      model_.typed().options.encoding == 3 && effect.kind != EffectKind::kReleases &&
      model_.fluent_symbol(*f).noninertial) {
    return;
  }
  const auto condition = grounder_.ground(effect.condition);
  if (!condition || *condition == model_.formulas().falsity()) return;
  const EffectRow row{effect.kind, *e, *f, *condition, origin_of(effect)};
  if (always) {
    rows_.add_always(row);
  } else {
    rows_.add(static_cast<Timepoint>(t), row);
  }
}

}  // namespace parallax::compiler
