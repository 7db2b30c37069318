#include <map>
#include <set>
#include <string>

#include "compiler/base/codes/names.h"
#include "compiler/lint/rules.h"
#include "compiler/sema/axiom_shapes.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {

namespace {

/// Completion of one predicate: over all axioms, or over those with the labels.
struct CompletedPredicate {
  bool over_everything = false;
  std::set<std::string> labels;
};
using Completed = std::map<std::uint32_t, CompletedPredicate>;  // by symbol

Completed completed_predicates(const TypedModel& model) {
  Completed completed;
  for (const auto& completion : model.completions) {
    auto& entry = completed[completion.predicate.index()];
    if (completion.label) {
      entry.labels.insert(*completion.label);
    } else {
      entry.over_everything = true;
    }
  }
  return completed;
}

std::set<std::string> named_labels(const TypedModel& model) {
  std::set<std::string> labels;
  for (const auto& completion : model.completions) {
    if (completion.label) labels.insert(*completion.label);
  }
  return labels;
}

}  // namespace

void find_unused_labels(const LintContext& context) {
  const auto& model = context.model();
  const auto completed = completed_predicates(model);
  const auto named = named_labels(model);
  for (const auto& axiom : model.axioms) {
    if (axiom.label.empty() || defines_by_effects(model, axiom) || named.contains(axiom.label))
      continue;
    for (const auto atom : positive_atoms(model, axiom.formula)) {
      const auto predicate = model.formulas[atom].predicate;
      const auto entry = completed.find(predicate.index());
      if (entry == completed.end() || entry->second.over_everything) continue;
      context.sink().warning(codes::kUnusedLabel, axiom.source, shortened(axiom.label),
                             model.symbols[predicate].name);
      break;
    }
  }
}

void find_completions_without_axiom(const LintContext& context) {
  const auto& model = context.model();
  std::set<std::string> labels;
  std::set<std::pair<std::string, std::uint32_t>> reasons;
  for (const auto& axiom : model.axioms) {
    if (axiom.label.empty()) continue;
    labels.insert(axiom.label);
    if (defines_by_effects(model, axiom)) continue;
    for (const auto atom : positive_atoms(model, axiom.formula)) {
      reasons.emplace(axiom.label, model.formulas[atom].predicate.index());
    }
  }
  for (const auto& completion : model.completions) {
    // A label that no formula has is told by the checker (W2005).
    if (!completion.label || !labels.contains(*completion.label)) continue;
    if (reasons.contains({*completion.label, completion.predicate.index()})) continue;
    context.sink().warning(codes::kCompletionWithoutAxiom, completion.source,
                           shortened(*completion.label), model.symbols[completion.predicate].name);
  }
}

void find_predicates_not_completed(const LintContext& context) {
  const auto& model = context.model();
  if (model.completions.empty()) return;
  const auto completed = completed_predicates(model);
  std::map<std::string, SymbolId> by_label;
  for (const auto& completion : model.completions) {
    if (completion.label) by_label.emplace(*completion.label, completion.predicate);
  }
  std::set<std::uint32_t> reported;
  for (const auto& axiom : model.axioms) {
    if (defines_by_effects(model, axiom) || context.built_in(axiom.source)) continue;
    for (const auto atom : positive_atoms(model, axiom.formula)) {
      const auto predicate = model.formulas[atom].predicate;
      if (completed.contains(predicate.index()) || reported.contains(predicate.index())) continue;
      const auto sibling = by_label.find(axiom.label);
      const bool event = predicate == model.core.happens;
      // A state formula under a label is no reason: fluents have inertia instead.
      const bool fluent = predicate == model.core.holds_at || predicate == model.core.released_at;
      if (fluent || (!event && (axiom.label.empty() || sibling == by_label.end()))) continue;
      reported.insert(predicate.index());
      const auto other =
          sibling != by_label.end() ? sibling->second : model.completions.front().predicate;
      context.sink().warning(
          codes::kNotCompleted, axiom.source, model.symbols[predicate].name,
          model.symbols[other].name,
          event ? std::string("events happen freely beside those that formulas ask for")
                : "this formula has the label `" + shortened(axiom.label) + "` as well");
    }
  }
}

}  // namespace parallax::compiler
