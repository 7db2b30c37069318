// Descriptions of a belief, for messages.

#include <algorithm>

#include "runtime/monitor/belief.h"

namespace parallax::runtime {

using compiler::FluentId;

std::vector<Disagreement> Belief::disagreement(const Observation& observed) {
  std::vector<StateId> states = possible_;
  if (!is_settled_) states = initial_states(known_).value_or(std::vector<StateId>());
  std::vector<Disagreement> none_has, nearest, never;
  std::optional<std::size_t> distance;
  for (std::size_t f = 0; f < observed.size(); ++f) {
    if (observed[f] == 0) continue;
    const Disagreement entry{FluentId(static_cast<std::uint32_t>(f)), observed[f] > 0};
    const auto place = fluent_bit_[f];
    const auto agrees = [&](StateId state) {
      return place ? bit(states_[state], *place) == entry.observed : !entry.observed;
    };
    if (std::none_of(states.begin(), states.end(), agrees)) none_has.push_back(entry);
  }
  if (!none_has.empty()) return none_has;
  for (const auto state : states) {
    std::vector<Disagreement> differing;
    for (std::size_t f = 0; f < observed.size(); ++f) {
      const auto place = fluent_bit_[f];
      if (observed[f] == 0 || !place || bit(states_[state], *place) == (observed[f] > 0)) continue;
      differing.push_back({FluentId(static_cast<std::uint32_t>(f)), observed[f] > 0});
    }
    if (distance && differing.size() >= *distance) continue;
    distance = differing.size();
    nearest = std::move(differing);
  }
  return nearest;
}

std::vector<std::size_t> Belief::plan_steps() const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < plan_bit_.size(); ++i) {
    const auto place = plan_bit_[i];
    if (place && std::any_of(possible_.begin(), possible_.end(),
                             [&](StateId state) { return bit(states_[state], *place); })) {
      out.push_back(i);
    }
  }
  return out;
}

bool Belief::plan_may_be_over() const {
  return !windows_.locations.empty() &&
         std::any_of(possible_.begin(), possible_.end(),
                     [&](StateId state) { return !is_at_perform(states_[state]); });
}

}  // namespace parallax::runtime
