#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/confidence/comparison.h"

namespace parallax::harness {

struct CampaignTrace;

/// The results of the simulations from one initial state.
struct StateCounts {
  std::string text;  // what tells it from the others: "TrolleyAt(onWay)"
  std::int64_t clean = 0, lost = 0, discrepancies = 0;
  std::shared_ptr<const CampaignTrace> trace = {};  // from it; null in a report that was read
  std::int64_t seen() const { return clean + discrepancies; }
};

/// The initial states that lead to a trace's events, and which of them were simulated.
struct StartResult {
  Initial law = Initial::kAll;
  std::string states_hash;  // StartStates::digest(); empty: not asked for
  /// Number of initial states, told apart by the fluents that are compared. None: more than are
  /// listed.
  std::optional<std::int64_t> all = 1;
  std::int64_t tried = 0;   // seen to the end of a simulation at least once
  std::int64_t visits = 0;  // simulations for their sake, which count for no claim
  /// Used only if the states are not all listed: the candidates that were drawn, and how many of
  /// them were no initial state of the trace.
  std::int64_t candidates = 0, refused = 0;
  /// Not all are listed and none could be drawn, so that the first stands for all.
  bool only_first = false;
  /// So few candidates are initial states that drawing ended before enough were simulated.
  bool ran_out = false;
  std::vector<std::string> unrealisable;       // no start of the world has them, with the reason
  std::map<std::int64_t, StateCounts> states;  // those that were simulated, by number

  /// Is there nothing to say?
  bool is_single() const { return all == 1; }
  /// Was every initial state tried, or is it written in the scenario that the first is enough?
  bool is_covered() const { return law == Initial::kFirst || (all && tried >= *all); }
};

}  // namespace parallax::harness
