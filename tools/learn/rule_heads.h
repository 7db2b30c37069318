#pragma once

#include <cstddef>
#include <vector>

#include "tools/learn/rule.h"

namespace parallax::tools {

/// Cost of a rule besides its conditions: roughly the bits that it takes to write one down.
constexpr int kRuleCost = 20;
/// Penalty for a rule that leaves examples to another one: up to it, a single dearer rule is
/// preferred.
constexpr int kAnotherRule = 30;

/// Every way to describe a fluent with these arguments relative to an event with those: by
/// arguments of the event, variables, constants. Rules without a condition, the cheapest first. For
/// kAdmits, which has no event, there is one, with a variable for each argument.
std::vector<LearnedRule> rule_heads(RuleKind kind, std::size_t event,
                                    const std::vector<std::size_t>& event_arguments,
                                    std::size_t fluent,
                                    const std::vector<std::size_t>& fluent_arguments,
                                    const LearnVocabulary& vocabulary);

}  // namespace parallax::tools
