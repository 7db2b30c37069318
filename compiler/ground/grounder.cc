#include "compiler/ground/grounder.h"

#include <algorithm>
#include <utility>

#include "compiler/formula/atoms.h"
#include "compiler/ground/completion.h"
#include "compiler/ground/effects.h"
#include "compiler/ground/formula_grounder.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

void assert_axiom(const Axiom& axiom, const GroundOptions& options, GroundModel& model,
                  FormulaGrounder& grounder, CompletionWriter& completion,
                  base::DiagnosticSink& sink) {
  grounder.start(axiom.source);
  const auto formula = grounder.ground(axiom.formula);
  if (grounder.failed()) return;
  auto& formulas = model.formulas();
  if (!formula) {
    sink.error(DiagnosticCode::kNothingToSay, axiom.source, model.horizon());
  } else if (*formula == formulas.falsity() && options.meaning == Meaning::kDecreasoner) {
    sink.warning(DiagnosticCode::kFalseFormulaDropped, axiom.source);
  } else if (*formula == formulas.falsity()) {
    sink.error(DiagnosticCode::kFormulaIsFalse, axiom.source);
  } else {
    model.require(*formula, model.add_origin(axiom.source, "axiom"));
    // A definition over effects (ECCausal, Clipped) says what happens, it is no reason for it.
    if (!axiom.mentions_effects) completion.note(axiom.label, *formula);
  }
}

/// An atom that stands in no formula is false.
void deny_unmentioned(GroundModel& model) {
  std::vector<FormulaId> asserted;
  for (const auto& constraint : model.constraints()) asserted.push_back(constraint.formula);
  const auto mentioned = atoms_of(model.formulas(), asserted);
  const auto origin = model.add_origin({}, "atom without a mention");
  const auto count = static_cast<std::int32_t>(model.atoms().size());
  for (std::int32_t variable = 1; variable <= count; ++variable) {
    if (std::binary_search(mentioned.begin(), mentioned.end(), variable)) continue;
    model.require(~model.formulas().atom(variable), origin);
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
  CompletionWriter completion(model, options.meaning);
  for (const auto& axiom : typed.axioms) {
    assert_axiom(axiom, options, model, grounder, completion, sink);
  }
  completion.write();
  assert_trajectories(model, rows, grounder);
  assert_inertia(model, rows);
  if (options.meaning == Meaning::kDecreasoner) deny_unmentioned(model);
  if (sink.error_count() != errors_before) return sink.already_reported();
  return model;
}

}  // namespace parallax::compiler
