#include "tools/app/start_guide.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "harness/campaign/loop_samples.h"
#include "tools/app/plan_reach.h"

namespace parallax::tools {
namespace {

// Number of starts whose whole execution is asked for.
constexpr std::size_t kMaxWhole = 200;

}  // namespace

StartCandidates start_candidates(const ScenarioModel& loaded, ClosedLoop& loop,
                                 const PlanCoverage& plan,
                                 const std::vector<std::vector<compiler::FluentId>>& states,
                                 const std::vector<compiler::FluentId>& fluents) {
  StartCandidates out;
  PlanReach reach(loaded, loop, plan);
  (void)reach.run();  // what was found before it was stopped is good
  std::set<const ReachingTrace*> seen;
  std::set<std::int64_t> begun;
  for (const auto& [key, reaching] : reach.found()) {
    const auto& holds = reaching->trace.points.front().holds;
    std::vector<compiler::FluentId> state;
    for (const auto fluent : fluents) {
      if (runtime::contains(holds, fluent)) state.push_back(fluent);
    }
    std::sort(state.begin(), state.end());
    const auto found = std::lower_bound(states.begin(), states.end(), state);
    if (found == states.end() || *found != state) continue;
    out.coverable.insert(key);
    if (!seen.insert(reaching.get()).second) continue;
    const auto start = found - states.begin() + 1;
    begun.insert(start);
    out.candidates.push_back({start, plan.covered_by(reaching->path)});
  }
  // Where what was looked for is over, the execution goes on; first those that are candidates.
  for (std::size_t i = 0; i < states.size() && begun.size() < kMaxWhole; ++i) {
    begun.insert(static_cast<std::int64_t>(i) + 1);
  }
  for (const auto start : begun) {
    const auto whole = reach.whole(states[static_cast<std::size_t>(start - 1)], fluents);
    if (whole) out.candidates.push_back({start, plan.covered_by(whole->path)});
  }
  return out;
}

ScenarioStartGuide::ScenarioStartGuide(StartCandidates starts, const PlanCoverage& plan,
                                       const ScenarioPlan& scenario_plan, std::uint64_t seed,
                                       int max_tries)
    : starts_(std::move(starts)),
      plan_(plan),
      scenario_plan_(scenario_plan),
      seed_(seed),
      max_tries_(max_tries),
      tries_(starts_.candidates.size(), 0),
      uncovered_(starts_.coverable) {}

std::optional<harness::GuidedStart> ScenarioStartGuide::next(std::int64_t sample) {
  auto open = uncovered_;
  for (const auto& [other, i] : under_way_) {
    for (const auto& key : starts_.candidates[i].items) open.erase(key);
  }
  std::optional<std::size_t> best;
  double most = 0.0;
  for (std::size_t i = 0; i < starts_.candidates.size(); ++i) {
    if (tries_[i] >= max_tries_) continue;
    const auto& items = starts_.candidates[i].items;
    // Earlier tries in vain lower the score.
    const auto promised =
        static_cast<double>(std::count_if(items.begin(), items.end(),
                                          [&](const auto& key) { return open.contains(key); })) /
        (1.0 + tries_[i]);
    if (promised <= most) continue;
    most = promised;
    best = i;
  }
  if (!best) return std::nullopt;
  ++tries_[*best];
  under_way_.emplace(sample, *best);
  const auto& chosen = starts_.candidates[*best];
  const auto first = std::find_if(chosen.items.begin(), chosen.items.end(),
                                  [&](const auto& key) { return open.contains(key); });
  return harness::GuidedStart{chosen.start,
                              fmt::format("{}:{} {}", first->file, first->line, first->id)};
}

void ScenarioStartGuide::tell(const harness::SampleRecord& record) {
  under_way_.erase(record.sample);
  if (record.status != harness::SampleStatus::kOk) return;
  const auto key = harness::LoopSamples::choices_key(seed_, record.sample);
  const auto path = scenario_plan_.retrace(key, record);
  if (!path) return;
  for (const auto& item : plan_.covered_by(*path)) uncovered_.erase(item);
}

}  // namespace parallax::tools
