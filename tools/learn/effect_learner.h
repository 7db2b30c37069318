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
  /// Steps that went differently from what looks like one state, in words.
  std::vector<std::string> contradictions;
  /// What no rule of the grammar explains.
  std::vector<std::string> unexplained;
};

/// For each event and each inertial fluent: what the event begins and ends, and under which
/// condition, from all steps at once. What follows one state and one event in different ways is
/// left open (`Releases`). Events of `attempted` are taken to happen also where the world refuses
/// them; of others the rules say when they cannot.
LearnedEffects learn_effects(const Observations& observations,
                             const std::set<std::string>& attempted, const std::atomic<bool>& stop);

}  // namespace parallax::tools
