#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace parallax::harness {

/// One simulation: the fluents that held in its initial state, and whether it failed.
struct StateRun {
  std::set<std::string> holds;
  bool failed = false;
};

/// Condition on the initial state that tells runs that failed from clean ones.
struct StateRule {
  /// One or two fluents with the value that each has; all of them must.
  std::vector<std::pair<std::string, bool>> literals;
  std::int64_t failures_inside = 0, failures = 0;
  std::int64_t clean_inside = 0, clean = 0;

  /// Does each run fail where it holds, and none elsewhere?
  bool is_exact() const { return failures_inside == failures && clean_inside == 0; }
};

/// The condition with the largest difference between its share of failures and its share of clean
/// runs, as long as failures gather there by chance with a probability of at most 0.01, all
/// conditions that were tried taken together.
std::optional<StateRule> state_rule(const std::vector<StateRun>& runs);

/// "It fails where `TrolleyAt(onWay)` at the start: 20 of 20 runs, elsewhere 0 of 38."
std::string state_words(const StateRule& rule);

}  // namespace parallax::harness
