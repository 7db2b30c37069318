#include "harness/campaign/judge.h"

#include <algorithm>

#include "compiler/base/contract.h"

namespace parallax::harness {

Judgement judge(const StateMapping& mapping, const std::vector<GroundFluent>& fluents,
                const CampaignTrace& trace, const std::vector<State>& observations) {
  PARALLAX_REQUIRE(observations.size() == trace.holds.size(), "one observation per timepoint");
  Judgement out;
  for (std::size_t t = 0; t < observations.size(); ++t) {
    std::vector<DivergingFluent> differing;
    for (const auto& fluent : fluents) {
      const auto observed = mapping.holds(fluent, observations[t], &out.missing);
      if (!observed) continue;  // ignored on purpose
      const bool predicted =
          std::binary_search(trace.holds[t].begin(), trace.holds[t].end(), fluent.text);
      if (*observed != predicted) {
        differing.push_back({fluent.text, static_cast<std::int64_t>(t), predicted, *observed});
      }
    }
    if (!differing.empty() && !out.first_divergence) {
      out.first_divergence = static_cast<std::int64_t>(t);
      out.first = differing;
    }
    if (t + 1 == observations.size()) out.last = std::move(differing);
  }
  return out;
}

}  // namespace parallax::harness
