#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

#include "tools/learn/observations.h"
#include "tools/learn/rule.h"

namespace parallax::tools {

/// A step and the fluent that it is about.
struct RuleExample {
  std::size_t transition = 0;
  std::vector<std::size_t> arguments;  // of the fluent
  friend bool operator==(const RuleExample&, const RuleExample&) = default;
};

/// Rules of one kind about one event and one fluent are looked for: one has to fire on each of
/// `shown`, none on any of `against`.
struct RuleProblem {
  RuleKind kind = RuleKind::kInitiates;
  std::size_t event = 0, fluent = 0;
  std::vector<RuleExample> shown, against;
};

struct RuleAnswer {
  std::vector<LearnedRule> rules;
  std::vector<RuleExample> unexplained;  // of `shown`
};

/// Rules that are as short and as general as may be: the first example that none explains yet is
/// taken for a pattern; its conditions are conjunctions of what held there, and the cheapest one
/// that excludes all of `against` is the rule, where one that explains all examples is preferred to
/// several. A condition that is not known to hold excludes nothing and explains nothing.
RuleAnswer find_rules(const RuleProblem& problem, const Observations& observations,
                      const std::atomic<bool>& stop);

}  // namespace parallax::tools
