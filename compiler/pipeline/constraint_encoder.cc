#include "compiler/pipeline/constraint_encoder.h"

#include "compiler/base/diagnostic_codes.h"

namespace parallax::compiler {

base::Status encode_constraints(const std::vector<StateConstraint>& constraints, Timepoint first,
                                GroundModel& model, FormulaGrounder& grounder,
                                base::DiagnosticSink& sink) {
  const auto origin = model.add_origin(constraints.front().source, OriginKind::kStateConstraint);
  auto& formulas = model.formulas();
  std::vector<bool> ever(constraints.size(), false);
  for (Timepoint t = first; t <= model.horizon(); ++t) {
    std::vector<FormulaId> parts;
    for (std::size_t i = 0; i < constraints.size(); ++i) {
      const auto& constraint = constraints[i];
      grounder.start(constraint.source);
      if (constraint.formula.time) {
        grounder.bind(*constraint.formula.time, model.terms().integer(t));
      }
      const auto value = grounder.ground(constraint.formula.formula);
      if (grounder.failed()) return sink.already_reported();
      if (value) ever[i] = true;
      if (value && model.needed_horizon_of(*value) > t) {
        return sink.error(base::DiagnosticCode::kConstraintLooksAhead, constraint.source);
      }
      parts.push_back(value.value_or(formulas.falsity()));
    }
    const auto hit = model.plan_atom(AtomKind::kHit, {}, t);
    model.require(formulas.equivalence(hit, formulas.conjunction(parts)), origin);
  }
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    if (ever[i]) continue;
    return sink.error(base::DiagnosticCode::kNothingToSay, constraints[i].source, model.horizon());
  }
  return base::Unit{};
}

}  // namespace parallax::compiler
