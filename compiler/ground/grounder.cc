#include "compiler/ground/grounder.h"

#include <utility>

#include "compiler/ground/effects.h"
#include "compiler/ground/formula_grounder.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

/// The conjuncts of an axiom `[v..] body`, one constraint for each instance of the outermost
/// quantifier, so that a core of clauses can name single timepoints.
void assert_axiom(const Axiom& axiom, GroundModel& model, FormulaGrounder& grounder,
                  base::DiagnosticSink& sink) {
  grounder.start(axiom.source);
  const auto formula = grounder.ground(axiom.formula);
  if (grounder.failed()) return;
  auto& formulas = model.formulas();
  if (!formula) {
    sink.error(DiagnosticCode::kNothingToSay, axiom.source, model.horizon());
  } else if (*formula == formulas.falsity()) {
    sink.error(DiagnosticCode::kFormulaIsFalse, axiom.source);
  } else {
    model.require(*formula, model.add_origin(axiom.source, "axiom"));
  }
}

}  // namespace

base::Result<GroundModel> ground_model(const TypedModel& typed, const GroundOptions& options,
                                       base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  GroundTermStore terms;
  auto universe = Universe::make(typed, options, terms, sink);
  if (!universe) return sink.already_reported();
  GroundModel model(typed, std::move(terms), *std::move(universe));
  FormulaGrounder grounder(model, options, sink);
  for (const auto& axiom : typed.axioms) assert_axiom(axiom, model, grounder, sink);
  assert_effects(model, grounder);
  for (const auto& completion : typed.completions) {
    sink.error(DiagnosticCode::kCompletionUnsupported, completion.source,
               typed.symbols[completion.predicate].name);
  }
  for (const auto& trajectory : typed.trajectories) {
    sink.error(DiagnosticCode::kTrajectoryUnsupported, trajectory.source);
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return model;
}

}  // namespace parallax::compiler
