#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

#include "tools/learn/observations.h"
#include "tools/learn/rule.h"

namespace parallax::tools {

/// A step and the fluent in question.
struct RuleExample {
  std::size_t transition = 0;
  std::vector<std::size_t> arguments;  // of the fluent
  friend bool operator==(const RuleExample&, const RuleExample&) = default;
};

/// Search for rules of one kind about one event and one fluent: one has to fire on each of `shown`,
/// none on any of `against`.
struct RuleProblem {
  RuleKind kind = RuleKind::kInitiates;
  std::size_t event = 0, fluent = 0;
  std::vector<RuleExample> shown, against;
};

struct RuleAnswer {
  std::vector<LearnedRule> rules;
  std::vector<RuleExample> unexplained;  // of `shown`
};

/// Finds rules that are as short and as general as possible. The first example without a rule is
/// taken as a pattern; candidate conditions are conjunctions of facts that held there. The cheapest
/// one that excludes all of `against` becomes the rule, but one that explains all examples is
/// preferred to several. A condition that is not known to hold excludes nothing and explains
/// nothing.
RuleAnswer find_rules(const RuleProblem& problem, const Observations& observations,
                      const std::atomic<bool>& stop);

}  // namespace parallax::tools
