#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/campaign/start_result.h"

namespace parallax::harness {

/// The initial states that get a simulation for their own sake, once enough was simulated for the
/// claim: all that no simulation was seen of, in rounds. States whose simulation was lost come
/// again, as long as a round helps and the limit of simulations has room for a whole one.
class VisitRounds {
 public:
  /// `starts` counts the simulations, also those of the rounds, and outlives the object. `states`:
  /// they are numbered from 1 to this; 0: none can be chosen.
  VisitRounds(const StartResult& starts, std::int64_t states) : starts_(starts), states_(states) {}

  /// The states of the next round. `room`: how many further simulations the limit admits. Empty if
  /// there is no further round.
  std::vector<std::int64_t> next(std::int64_t room);

 private:
  const StartResult& starts_;
  std::int64_t states_;
  std::optional<std::int64_t> tried_before_;  // the last round
};

}  // namespace parallax::harness
