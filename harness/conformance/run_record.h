#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// An action that a simulator is tried with.
struct TriedAction {
  std::string controller;
  State arguments;
  double time_limit_s = 60.0;
};

/// One run: what was observed after the reset and after each action, and what became of those.
struct RunRecord {
  std::vector<Outcome> outcomes;  // of the reset, then of the actions
  std::vector<State> states;
};

/// How two runs, or two states, part. `kNumbers`: only in numbers, by `largest` at most.
struct RunDifference {
  enum class Kind : std::uint8_t { kNone, kNumbers, kDiscrete };
  Kind kind = Kind::kNone;
  double largest = 0.0;
  std::string where;  // "`box.x` after `push`: 1.5 and 1.4"

  /// Takes over what is worse.
  void add(const RunDifference& other);
};

/// A digest that differs is a difference in numbers, however small.
RunDifference difference_of(const State& a, const State& b, const std::string& when);
/// The difference between two runs. The durations of an action may differ by `time_slack_s` without
/// being counted in `largest`: clocks go in steps. Without `with_digest`, digests are not compared:
/// those of two runs whose seeds differ may well differ while nothing else does.
RunDifference difference_of(const RunRecord& a, const RunRecord& b,
                            const std::vector<TriedAction>& actions, double time_slack_s,
                            bool with_digest = true);

std::string text_of(const Value& value);

}  // namespace parallax::harness
