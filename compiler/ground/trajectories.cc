#include <map>
#include <tuple>

#include "compiler/ground/effects.h"

namespace parallax::compiler {
namespace {

class TrajectoryWriter {
 public:
  TrajectoryWriter(GroundModel& model, const EffectRows& rows, FormulaGrounder& grounder)
      : model_(model), rows_(rows), grounder_(grounder) {}

  void write(const TrajectoryAxiom& axiom) {
    origin_ = model_.add_origin(axiom.source, "trajectory axiom");
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
    if (t < 0 || d <= 0 || d > model_.horizon() || t + d > model_.horizon()) return;
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
    auto& chain = chains_[{kind, fluent, begin}];
    auto& formulas = model_.formulas();
    if (chain.empty()) chain.push_back(rows_.changed(starts, fluent, begin, model_));
    // chain[k]: running until begin + 1 + k.
    while (static_cast<Timepoint>(chain.size()) < end - begin) {
      const auto last = begin + static_cast<Timepoint>(chain.size());
      if (chain.back() == formulas.falsity()) return formulas.falsity();
      const auto goes_on =
          formulas.conjunction(chain.back(), ~rows_.changed(stops, fluent, last, model_));
      if (formulas.kind(goes_on) == FormulaNodeKind::kAnd && !goes_on.negated()) {
        const auto next = model_.auxiliary_atom(last + 1);
        model_.require(formulas.implication(goes_on, next), origin_);
        chain.push_back(next);
      } else {
        chain.push_back(goes_on);
      }
    }
    return chain[static_cast<std::size_t>(end - begin) - 1];
  }

  GroundModel& model_;
  const EffectRows& rows_;
  FormulaGrounder& grounder_;
  std::uint32_t origin_ = 0;
  std::map<std::tuple<TrajectoryKind, std::uint32_t, Timepoint>, std::vector<FormulaId>> chains_;
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
