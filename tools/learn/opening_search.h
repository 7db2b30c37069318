#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/learn/observations.h"
#include "tools/learn/rule.h"

namespace parallax::tools {

/// How often a fluent was true and false after one state and one event (kReleases), or in one state
/// (kAdmits).
struct OpeningExample {
  std::size_t state = 0;
  std::vector<std::size_t> event_arguments, fluent_arguments;
  std::size_t held = 0, failed = 0;  // runs
  bool open = false;                 // seen to be left open here: a rule has to say so
  std::vector<std::string> runs;
};

struct OpeningProblem {
  RuleKind kind = RuleKind::kReleases;
  std::size_t event = 0, fluent = 0;
  std::vector<OpeningExample> examples;
  /// Limit on the bits for examples that are not covered and never went both ways: other axioms may
  /// describe them more briefly than chance would.
  double most_outside = 0.0;
};

/// Values of OpeningProblem::most_outside to be tried one after the other, in bits.
constexpr std::array<double, 5> kMostOutside = {1e9, 160.0, 80.0, 40.0, 0.0};

/// Bits that tell which way the examples went, given only the rule that covers each; `rules`: by
/// the place of an example, its rule or none.
double bits_of(const OpeningProblem& problem, const std::vector<std::optional<std::size_t>>& rules);

/// Finds where chance decides, as a condition of its own: rules that cover every open example, with
/// the shortest description of all observations. A condition costs its length; covered examples
/// cost the bits that tell which way they went each time, so that a rule is as general as the runs
/// allow: a rule that also covers examples that always go one way is replaced by a longer condition
/// when enough runs have shown that. Open examples stay open with more runs.
std::vector<LearnedRule> find_openings(const OpeningProblem& problem,
                                       const LearnVocabulary& vocabulary,
                                       const std::vector<std::vector<Truth>>& states,
                                       const std::atomic<bool>& stop);
/// Rules that leave less open than this one but still every example that was seen to be open: with
/// one more condition, or another one instead of its only one. A few, those that leave out most
/// first.
std::vector<LearnedRule> narrower_openings(const OpeningProblem& problem, const LearnedRule& rule,
                                           const LearnVocabulary& vocabulary,
                                           const std::vector<std::vector<Truth>>& states);
/// The same for kAdmits, with the value of most_outside that gives the shortest description:
/// examples that are not covered need no explanation. A rule is certain where it covers open
/// examples only.
std::vector<LearnedRule> shortest_exceptions(OpeningProblem problem,
                                             const LearnVocabulary& vocabulary,
                                             const std::vector<std::vector<Truth>>& states,
                                             const std::atomic<bool>& stop);

}  // namespace parallax::tools
