#pragma once

#include <optional>
#include <string>

#include "compiler/lint/lint_context.h"

namespace parallax::compiler {

// The rules behind the tables of lint.cc; what each looks for stands there.

// symbol_rules.cc
void find_fluents_without_effects(const LintContext& context);
void find_fluents_that_change_one_way(const LintContext& context);
void find_events_without_effect(const LintContext& context);
void find_unused_sorts(const LintContext& context);
void find_empty_sorts(const LintContext& context);

// reason_rules.cc
void find_unused_labels(const LintContext& context);
void find_completions_without_axiom(const LintContext& context);
void find_predicates_not_completed(const LintContext& context);

// completion_rules.cc
void find_invented_predicates(const LintContext& context);
void find_repeated_completions(const LintContext& context);

// horizon_rule.cc
void find_horizon_dependences(const LintContext& context);

// contradiction.cc
void find_impossible_conditions(const LintContext& context);

// range_rules.cc
void find_single_value_ranges(const LintContext& context);
void find_short_offset_ranges(const LintContext& context);
void find_comparisons_outside_ranges(const LintContext& context);

// statement_rules.cc
void find_unused_variables(const LintContext& context);
void find_shared_exclusions(const LintContext& context);

// effect_rules.cc
void find_effect_arguments(const LintContext& context);
void find_noninertial_effects(const LintContext& context);
void find_nested_arithmetic(const LintContext& context);

// fact_rule.cc
void find_facts_beside_rules(const LintContext& context);

/// Reason why the condition cannot hold in any instance, as the end of a sentence; none where that
/// is not plain from the condition alone. Only its conjuncts are examined, also those below `{..}`:
/// a term compared with itself, two constants, a term equated with different constants or bounded
/// by numbers that leave nothing between them, a literal beside its negation. Sound: a condition
/// that is reported cannot hold. Linear in the condition but for look-ups.
std::optional<std::string> contradiction(const LintContext& context, TypedFormulaId condition);

}  // namespace parallax::compiler
