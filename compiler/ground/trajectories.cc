#include "compiler/ground/effects.h"
#include "compiler/ground/instances.h"

namespace parallax::compiler {
namespace {

class TrajectoryWriter {
 public:
  TrajectoryWriter(GroundModel& model, const EffectRows& rows, FormulaGrounder& grounder)
      : model_(model), rows_(rows), grounder_(grounder) {}

  void write(const TrajectoryAxiom& axiom) {
    const auto origin = model_.add_origin(axiom.source, "trajectory axiom");
    grounder_.start(axiom.source);
    for_each_instance(axiom.variables, model_, grounder_, [&] { instance(axiom, origin); });
  }

 private:
  /// Does an event change the fluent this way at t?
  FormulaId changed(EffectKind kind, std::uint32_t fluent, Timepoint t) {
    std::vector<FormulaId> triggers;
    for (const auto& row : rows_.at(t)) {
      if (row.kind != kind || row.fluent != fluent) continue;
      triggers.push_back(
          model_.formulas().conjunction(model_.happens(row.event, t), row.condition));
    }
    return model_.formulas().disjunction(std::move(triggers));
  }

  void instance(const TrajectoryAxiom& axiom, std::uint32_t origin) {
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
    if (t < 0 || d <= 0 || d > model_.horizon() || t + d > model_.horizon()) return;
    const auto condition = grounder_.ground(axiom.condition);
    if (!condition) return;

    const auto begin = static_cast<Timepoint>(t);
    const auto end = static_cast<Timepoint>(t + d);
    const bool forward = axiom.kind == TrajectoryKind::kTrajectory;
    const auto starts = forward ? EffectKind::kInitiates : EffectKind::kTerminates;
    const auto stops = forward ? EffectKind::kTerminates : EffectKind::kInitiates;
    std::vector<FormulaId> premises = {*condition, changed(starts, *f1, begin)};
    for (Timepoint s = begin + 1; s < end; ++s) premises.push_back(~changed(stops, *f1, s));
    auto& formulas = model_.formulas();
    model_.require(
        formulas.implication(formulas.conjunction(std::move(premises)), model_.holds(*f2, end)),
        origin);
  }

  GroundModel& model_;
  const EffectRows& rows_;
  FormulaGrounder& grounder_;
};

}  // namespace

void assert_trajectories(GroundModel& model, const EffectRows& rows, FormulaGrounder& grounder) {
  TrajectoryWriter writer(model, rows, grounder);
  for (const auto& axiom : model.typed().trajectories) {
    writer.write(axiom);
    if (grounder.failed()) return;
  }
}

}  // namespace parallax::compiler
