#include "compiler/lint/lint.h"

#include <array>

#include "compiler/base/codes/names.h"
#include "compiler/lint/rules.h"

namespace parallax::compiler {

using base::DiagnosticCode;

std::span<const LintRule> lint_rules() {
  static constexpr std::array<LintRule, 18> kRules = {{
      {codes::kFluentWithoutEffects, "fluent-without-effects",
       "an inertial fluent that no event changes", find_fluents_without_effects},
      {codes::kFluentOneWay, "fluent-one-way",
       "a fluent that events only initiate or only terminate", find_fluents_that_change_one_way},
      {codes::kEventWithoutEffect, "event-without-effect", "an event that no axiom mentions",
       find_events_without_effect},
      {codes::kUnusedSort, "unused-sort", "a sort that nothing is made of", find_unused_sorts},
      {codes::kEmptySort, "empty-sort", "a sort in use without an element", find_empty_sorts},
      {codes::kUnusedLabel, "unused-label",
       "a label that no completion names, although its predicate is completed over others",
       find_unused_labels},
      {codes::kCompletionWithoutAxiom, "completion-without-axiom",
       "completion over a label whose formulas give no reason for the predicate",
       find_completions_without_axiom},
      {codes::kConditionNeverHolds, "condition-never-holds", "a condition that contradicts itself",
       find_impossible_conditions},
      {codes::kSingleValueRange, "single-value-range", "a range of one number",
       find_single_value_ranges},
      {codes::kShortOffsetRange, "short-offset-range",
       "offsets that do not reach the end of the horizon", find_short_offset_ranges},
      {codes::kComparedOutsideRange, "compared-outside-range",
       "a comparison with a number that the variable never reaches",
       find_comparisons_outside_ranges},
      {codes::kNotCompleted, "not-completed",
       "a predicate with reasons but without completion, beside completed ones",
       find_predicates_not_completed},
      {codes::kUnusedVariable, "unused-variable", "a variable that is bound in vain",
       find_unused_variables},
      {codes::kEffectArguments, "effect-arguments", "an effect axiom that stops the 2005 reasoner",
       find_effect_arguments},
      {codes::kSharedExclusion, "shared-exclusion",
       "mutex and xor that exclude less than their names say", find_shared_exclusions},
      {codes::kInventedByEvent, "invented-by-event",
       "a precondition that a completion takes for a reason", find_invented_predicates},
      {codes::kCompletedTwice, "completed-twice", "a predicate with several completions",
       find_repeated_completions},
      {codes::kDependsOnHorizon, "depends-on-horizon",
       "a formula that says less of earlier timepoints at a longer horizon",
       find_horizon_dependences},
  }};
  return kRules;
}

std::span<const LintRule> difference_rules() {
  static constexpr std::array<LintRule, 3> kRules = {{
      {codes::kFactBesideRule, "fact-beside-rule",
       "a completed fact for which there are rules as well", find_facts_beside_rules},
      {codes::kNoninertialEffect, "noninertial-effect",
       "an effect on a fluent that is always released", find_noninertial_effects},
      {codes::kNestedArithmetic, "nested-arithmetic",
       "arithmetic inside arithmetic in an effect axiom", find_nested_arithmetic},
  }};
  return kRules;
}

std::span<const LintRule> horizon_rules() {
  static constexpr std::array<LintRule, 1> kRules = {
      {{codes::kDependsOnHorizon, "depends-on-horizon",
        "a formula that says less of earlier timepoints at a longer horizon",
        find_horizon_dependences}}};
  return kRules;
}

std::span<const DiagnosticCode> reproduced_differences() {
  static constexpr std::array<DiagnosticCode, 2> kCodes = {codes::kFactBesideRule,
                                                           codes::kNoninertialEffect};
  return kCodes;
}

void lint_model(std::span<const LintRule> rules, const ModelAst& ast, const TypedModel& model,
                base::DiagnosticSink& sink) {
  const LintContext context(ast, model, sink);
  for (const auto& rule : rules) rule.run(context);
}

}  // namespace parallax::compiler
