#include "compiler/ground/grounder.h"

#include <utility>

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
  const auto& formulas = model.formulas();
  std::vector<bool> seen(formulas.node_count(), false);
  std::vector<bool> mentioned(model.atoms().size() + 1, false);
  std::vector<FormulaId> todo;
  for (const auto& constraint : model.constraints()) todo.push_back(constraint.formula);
  while (!todo.empty()) {
    const auto id = todo.back();
    todo.pop_back();
    if (seen[id.node()]) continue;
    seen[id.node()] = true;
    if (formulas.kind(id) == FormulaNodeKind::kAtom) {
      mentioned[static_cast<std::size_t>(formulas.variable(id))] = true;
    } else if (formulas.kind(id) == FormulaNodeKind::kAnd) {
      const auto children = formulas.children(id);
      todo.insert(todo.end(), children.begin(), children.end());
    }
  }
  const auto origin = model.add_origin({}, "atom without a mention");
  for (std::size_t v = 1; v < mentioned.size(); ++v) {
    if (mentioned[v]) continue;
    model.require(~model.formulas().atom(static_cast<std::int32_t>(v)), origin);
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
