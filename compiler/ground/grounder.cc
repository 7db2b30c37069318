#include "compiler/ground/grounder.h"

#include <utility>

#include "compiler/ground/completion.h"
#include "compiler/ground/effects.h"
#include "compiler/ground/formula_grounder.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

void assert_axiom(const Axiom& axiom, GroundModel& model, FormulaGrounder& grounder,
                  CompletionWriter& completion, base::DiagnosticSink& sink) {
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
    completion.note(axiom.label, *formula);
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
  const auto rows = ground_effects(model, grounder);
  grounder.use_effects(rows);
  CompletionWriter completion(model);
  for (const auto& axiom : typed.axioms) assert_axiom(axiom, model, grounder, completion, sink);
  completion.write();
  assert_trajectories(model, rows, grounder);
  assert_inertia(model, rows);
  if (sink.error_count() != errors_before) return sink.already_reported();
  return model;
}

}  // namespace parallax::compiler
