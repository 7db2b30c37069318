#pragma once

#include <cstddef>
#include <vector>

#include "tools/learn/rule.h"

namespace parallax::tools {

/// What a rule costs besides its conditions: as many bits as telling one takes, roughly.
constexpr int kRuleCost = 20;
/// What a rule may cost more that makes others needless.
constexpr int kAnotherRule = 30;

/// Every way to say what the fluent with these arguments is to an event with those: arguments of
/// the event, variables, constants. Rules without a condition, the cheapest first. Of kAdmits,
/// which is about no event, there is one, with a variable for each argument.
std::vector<LearnedRule> rule_heads(RuleKind kind, std::size_t event,
                                    const std::vector<std::size_t>& event_arguments,
                                    std::size_t fluent,
                                    const std::vector<std::size_t>& fluent_arguments,
                                    const LearnVocabulary& vocabulary);

}  // namespace parallax::tools
