#include "harness/campaign/start_visits.h"

#include <iterator>

namespace parallax::harness {

std::vector<std::int64_t> VisitRounds::next(std::int64_t room) {
  if (tried_before_ == starts_.tried) return {};
  std::vector<std::int64_t> left;
  for (std::int64_t state = 1; state <= states_; ++state) {
    const auto found = starts_.states.find(state);
    if (found == starts_.states.end() || found->second.seen() == 0) left.push_back(state);
  }
  if (std::ssize(left) > room) return {};
  tried_before_ = starts_.tried;
  return left;
}

}  // namespace parallax::harness
