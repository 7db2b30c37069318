#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/bench/mistakes/mistake_trial.h"

namespace parallax::tools {

struct MistakeBenchOptions {
  TrialOptions trial;
  std::vector<std::string> worlds;  // empty: all
  std::size_t per_kind = 9;         // mistakes of a kind in a world
  std::size_t at_most = 1000;       // single mistakes of a world, spread over all kinds
  std::size_t doubles = 10;         // pairs of shown mistakes in a world
  double seconds = 1e9;             // of the clock; what is not begun by then is left out
};

/// Measures the worlds by turns, so that whatever is done when time is over is spread over all of
/// them. `known` are not measured again; each new outcome is told at once. Returns all of them;
/// `error` is filled in if a world cannot be used.
std::vector<MistakeOutcome> measure_mistakes(const MistakeBenchOptions& options,
                                             const std::vector<MistakeOutcome>& known,
                                             const std::function<void(const MistakeOutcome&)>& told,
                                             std::string& error);

}  // namespace parallax::tools
