#pragma once

#include <atomic>
#include <set>
#include <string>
#include <vector>

#include "tools/learn/observations.h"
#include "tools/learn/rule.h"

namespace parallax::tools {

/// Rules that explain the outcome of every observed step.
struct LearnedEffects {
  std::vector<LearnedRule> rules;  // by event, in the order of the model
  /// Fluents that a rule leaves open and that keep their value where no rule is about them, as
  /// every observed step shows. Without those that only outcomes tell.
  std::set<std::size_t> settled;
  /// Steps with different outcomes from what looks like one state, in words.
  std::vector<std::string> contradictions;
};

/// Learns for each event and each inertial fluent what the event begins and ends, and under which
/// condition, from all steps at once. Outcomes that differ after the same state and event are left
/// open (`Releases`), there and wherever they may well differ, too (find_openings).
/// `from_outcomes`: fluents that are known where a perform tells them, and never before it. Events
/// of `attempted` are taken to happen also where the world refuses them; for others the rules say
/// when they cannot.
LearnedEffects learn_effects(const Observations& observations,
                             const std::set<std::string>& attempted,
                             const std::set<std::string>& from_outcomes,
                             const std::atomic<bool>& stop);

}  // namespace parallax::tools
