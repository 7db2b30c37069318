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

/// How often a fluent was seen so and so behind one state and one event (kReleases), or in one
/// state (kAdmits).
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
  /// At most so many bits are needed to say what is not covered and never went both ways: other
  /// axioms may say it shorter than chance would.
  double most_outside = 0.0;
};

/// Bits, of which one is tried after the other as OpeningProblem::most_outside.
constexpr std::array<double, 5> kMostOutside = {1e9, 160.0, 80.0, 40.0, 0.0};

/// The bits that tell which way examples went of which nothing else is known but the rule that
/// covers them; `rules` of each example, by its place, or none.
double bits_of(const OpeningProblem& problem, const std::vector<std::optional<std::size_t>>& rules);

/// Where chance decides, as a condition of its own: rules that cover every open example, with the
/// shortest description of all that was seen. A condition costs its length; what a rule covers
/// costs the bits that tell which way it went each time, so that a rule is as general as the runs
/// allow: one that also covers what always goes one way is given up for a longer condition when
/// enough runs have shown it. What is open stays open with more runs.
std::vector<LearnedRule> find_openings(const OpeningProblem& problem,
                                       const LearnVocabulary& vocabulary,
                                       const std::vector<std::vector<Truth>>& states,
                                       const std::atomic<bool>& stop);
/// Rules that leave less open than this one, and all that was seen to be open: with one more
/// condition, or another one instead of its only one. Those that leave out most come first, a few.
std::vector<LearnedRule> narrower_openings(const OpeningProblem& problem, const LearnedRule& rule,
                                           const LearnVocabulary& vocabulary,
                                           const std::vector<std::vector<Truth>>& states);
/// The same for kAdmits, with the value of most_outside that gives the shortest description:
/// nothing else explains what is not covered, and nothing has to. A rule is certain where it covers
/// nothing that is not open.
std::vector<LearnedRule> shortest_exceptions(OpeningProblem problem,
                                             const LearnVocabulary& vocabulary,
                                             const std::vector<std::vector<Truth>>& states,
                                             const std::atomic<bool>& stop);

}  // namespace parallax::tools
