#pragma once

#include <atomic>
#include <set>
#include <string>
#include <vector>

#include "tools/learn/observations.h"
#include "tools/learn/rule.h"

namespace parallax::tools {

/// Rules that say of every step that was seen what it did.
struct LearnedEffects {
  std::vector<LearnedRule> rules;  // by event, in the order of the model
  /// Fluents that a rule leaves open and that stay as they are where no rule is about them: what
  /// every step shows that was seen. Not those that only outcomes tell.
  std::set<std::size_t> settled;
  /// Steps that went differently from what looks like one state, in words.
  std::vector<std::string> contradictions;
};

/// For each event and each inertial fluent: what the event begins and ends, and under which
/// condition, from all steps at once. What follows one state and one event in different ways is
/// left open (`Releases`), there and where it may well go in different ways, too (find_openings).
/// `from_outcomes`: fluents that are known where a perform tells them, and never before it. Events
/// of `attempted` are taken to happen also where the world refuses them; of others the rules say
/// when they cannot.
LearnedEffects learn_effects(const Observations& observations,
                             const std::set<std::string>& attempted,
                             const std::set<std::string>& from_outcomes,
                             const std::atomic<bool>& stop);

}  // namespace parallax::tools
