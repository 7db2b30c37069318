#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/learn/observations.h"
#include "tools/learn/rule.h"

namespace parallax::tools {

/// Open outcomes of one event that one chance decides: "if the robot arrives, the camera looks
/// elsewhere, else it does not". `openings` are the rules of kReleases about the event, `steps` its
/// transitions. Two outcomes are tied (kTies) where no step contradicts that, and where the tie is
/// shorter than a description of which way the second one went each time: a coincidence of few runs
/// ties nothing.
struct OutcomeTie {
  LearnedRule rule;        // kTies
  std::size_t second = 0;  // of `openings`, the one that follows
  /// The second opening with the conditions of the first one as well: elsewhere it went one way
  /// each time.
  std::optional<LearnedRule> narrower;
};
std::vector<OutcomeTie> find_ties(const std::vector<LearnedRule>& openings,
                                  const std::vector<std::size_t>& steps,
                                  const Observations& observations, const std::atomic<bool>& stop);

}  // namespace parallax::tools
