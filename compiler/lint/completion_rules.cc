#include <map>
#include <optional>
#include <set>

#include "compiler/base/codes/names.h"
#include "compiler/lint/rules.h"
#include "compiler/sema/axiom_shapes.h"

namespace parallax::compiler {
namespace {

/// Is the predicate one of the model's own, which neither time nor events have a part in?
bool is_static(const TypedModel& model, SymbolId predicate) {
  const auto& core = model.core;
  if (predicate == core.happens || predicate == core.holds_at || predicate == core.released_at) {
    return false;
  }
  for (const auto sort : model.symbols[predicate].arguments) {
    for (const auto timed : {core.time, core.event, core.fluent}) {
      if (timed && model.sorts_overlap(sort, *timed)) return false;
    }
  }
  return true;
}

/// Finds a Happens that the formula asks for: in the condition of
/// `Happens(..) -> P(..)`, below `!` in `!Happens(..) | P(..)`.
std::optional<TypedFormulaId> asked_event(const TypedModel& model, TypedFormulaId root) {
  std::set<std::uint32_t> positive;
  for (const auto atom : positive_atoms(model, root)) positive.insert(atom.index());
  std::optional<TypedFormulaId> found;
  for_each_formula(model, root, [&](TypedFormulaId id) {
    const auto& formula = model.formulas[id];
    const bool event =
        formula.kind == FormulaKind::kAtom && formula.predicate == model.core.happens;
    if (event && !positive.contains(id.index()) && !found) found = id;
  });
  return found;
}

bool counts(const Completion& completion, const Axiom& axiom) {
  return !completion.label || *completion.label == axiom.label;
}

}  // namespace

void find_invented_predicates(const LintContext& context) {
  const auto& model = context.model();
  for (const auto& completion : model.completions) {
    if (!is_static(model, completion.predicate)) continue;
    const Axiom* event_axiom = nullptr;
    TypedFormulaId event;
    bool has_definition = false;
    for (const auto& axiom : model.axioms) {
      if (!counts(completion, axiom) || defines_by_effects(model, axiom)) continue;
      bool reason = false;
      for (const auto atom : positive_atoms(model, axiom.formula)) {
        reason = reason || model.formulas[atom].predicate == completion.predicate;
      }
      if (!reason) continue;
      const auto asked = asked_event(model, axiom.formula);
      has_definition = has_definition || !asked;
      if (!asked || event_axiom != nullptr) continue;
      event_axiom = &axiom;
      event = *asked;
    }
    // A predicate that only events bring about, such as Visited, is defined by them.
    if (event_axiom == nullptr || !has_definition) continue;
    const auto& term = model.formulas[event].terms[0];
    auto warning = context.sink().warning(codes::kInventedByEvent, event_axiom->source,
                                          model.symbols[completion.predicate].name,
                                          context.text(model.terms[term].source));
    warning.note(completion.source, "completed here");
  }
}

void find_repeated_completions(const LintContext& context) {
  const auto& model = context.model();
  std::map<std::uint32_t, const Completion*> first;
  for (const auto& completion : model.completions) {
    const auto [known, added] = first.try_emplace(completion.predicate.index(), &completion);
    if (added || context.built_in(completion.source)) continue;
    auto warning = context.sink().warning(codes::kCompletedTwice, completion.source,
                                          model.symbols[completion.predicate].name);
    warning.note(known->second->source, "completed here before");
  }
}

}  // namespace parallax::compiler
