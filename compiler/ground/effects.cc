#include "compiler/ground/effects.h"

#include "compiler/ground/instances.h"

namespace parallax::compiler {
namespace {

class EffectGrounder {
 public:
  EffectGrounder(GroundModel& model, FormulaGrounder& grounder)
      : model_(model), grounder_(grounder), rows_(model.horizon()) {}

  EffectRows run() && {
    for (const auto& effect : model_.typed().effects) {
      origin_ = model_.add_origin(effect.source, "effect axiom");
      grounder_.start(effect.source);
      const auto& time = model_.typed().terms[effect.time];
      auto open = effect.variables;
      if (time.kind == TermKind::kVariable) std::erase(open, time.variable);
      for (Timepoint t = 0; t < model_.horizon() && !grounder_.failed(); ++t) {
        const auto now = model_.terms().integer(t);
        if (time.kind == TermKind::kVariable) grounder_.bind(time.variable, now);
        for_each_instance(open, model_, grounder_, [&] { instance(effect, now, t); });
      }
    }
    return std::move(rows_);
  }

 private:
  void instance(const EffectAxiom& effect, GroundTermId now, Timepoint t) {
    if (grounder_.term(effect.time) != now) return;
    const auto event = grounder_.term(effect.event);
    const auto fluent = grounder_.term(effect.fluent);
    if (!event || !fluent) return;
    const auto e = model_.event_number(*event);
    const auto f = model_.fluent_number(*fluent);
    if (!e || !f) return;
    const auto condition = grounder_.ground(effect.condition);
    if (!condition || *condition == model_.formulas().falsity()) return;
    rows_.add(t, {effect.kind, *e, *f, *condition, origin_});
  }

  GroundModel& model_;
  FormulaGrounder& grounder_;
  EffectRows rows_;
  std::uint32_t origin_ = 0;
};

}  // namespace

EffectRows ground_effects(GroundModel& model, FormulaGrounder& grounder) {
  return EffectGrounder(model, grounder).run();
}

}  // namespace parallax::compiler
