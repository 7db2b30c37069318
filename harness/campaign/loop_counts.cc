#include "harness/campaign/loop_counts.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "harness/campaign/run_setup.h"

namespace parallax::harness {
namespace {

constexpr double kRateLevel = 0.95;  // of the intervals of rates, as of `parallax rates`

}  // namespace

void count_path(const SampleRecord& record, LoopResult& loop) {
  PathCount path;
  path.end = record.path->end;
  path.detail = record.path->detail;
  path.example = record.sample;
  for (const auto& step : record.path->steps) {
    path.events.push_back(step.object.empty() ? step.event : step.event + "=" + step.object);
    path.outcomes.push_back(step.succeeded ? "ok" : step.condition);
  }
  auto& paths = loop.paths;
  const auto same = std::find_if(paths.begin(), paths.end(), [&](const PathCount& other) {
    return other.events == path.events && other.outcomes == path.outcomes &&
           other.end == path.end && other.detail == path.detail;
  });
  ++(same == paths.end() ? paths.emplace_back(std::move(path)) : *same).runs;
}

void claim_executions(const Scenario& scenario, const Tally& tally, DrawnStarts drawn,
                      TraceResult& stream) {
  const auto& criterion = scenario.criterion;
  const auto& loop = *stream.loop;
  const auto bound = certified_bound(tally, criterion.confidence_level);
  stream.certified_level = bound.confidence_level;
  stream.certified_epsilon = bound.epsilon;
  stream.claim = loop_claim(tally, criterion, scenario.comparison(),
                            {loop.initial_states, stream.starts.tried, loop.has_weights,
                             std::move(drawn), std::ssize(stream.starts.unrealisable)});
  stream.caveats = caveats(tally, criterion, std::nullopt);
  if (loop.unfinished == 0) return;
  stream.certified_epsilon = 1.0;
  stream.claim = "nothing is claimed: an execution did not end";
}

void add_loop_caveats(TraceResult& stream) {
  const auto& loop = *stream.loop;
  if (loop.unfinished > 0) stream.caveats.push_back(loop.why_unfinished);
  if (const auto guided = loop.guided.value_or(0); guided > 0) {
    stream.caveats.push_back(
        fmt::format("{} of the executions began in states that were chosen; the claim is about the "
                    "others alone, whose starts were drawn",
                    guided));
  }
}

void rate_causes(const FixedCount& counted, bool lost_too_often, bool interrupted,
                 TraceResult& stream) {
  auto& loop = *stream.loop;
  loop.causes_level = kRateLevel;
  loop.causes_unseen = (lost_too_often ? counted.planned() : counted.counted()) - loop.causes_runs;
  // An interruption is not planned, so the number of executions was not fixed.
  const auto set = interrupted ? set_anytime_interval : set_interval;
  for (auto& rate : loop.causes) set(rate, loop.causes_runs, loop.causes_unseen, kRateLevel);
  if (loop.causes.empty()) return;
  if (interrupted) {
    stream.caveats.emplace_back(
        "the run was stopped, so the intervals of causes are those that hold whenever one looks");
  }
  if (loop.causes_unseen > 0) stream.caveats.push_back(unseen_text(loop.causes_unseen));
  if (loop.guided.value_or(0) > 0 || counted.goes_on()) {
    stream.caveats.push_back(fmt::format(
        "how often each cause comes is counted in the first {} executions with a drawn start: a "
        "number that nothing seen decides",
        counted.counted()));
  }
  std::stable_sort(loop.causes.begin(), loop.causes.end(),
                   [](const auto& a, const auto& b) { return a.count > b.count; });
}

std::string why_unfinished(const ExecutedPath& path, const Scenario& scenario) {
  switch (path.end) {
    case PathEnd::kPerformLimit:
      return fmt::format("the plan had not ended after {} performs (limits: max_performs)",
                         path.steps.size());
    case PathEnd::kTimeLimit:
      return fmt::format(
          "the plan had not ended after {:g} s of simulated time (limits: max_simulated_s)",
          scenario.limits.max_simulated_s);
    case PathEnd::kCut:
      return fmt::format("the plan came to the end of the unrolling of `{}`", path.detail);
    case PathEnd::kDone:
    case PathEnd::kFailed:
    case PathEnd::kUnboundReason:
    case PathEnd::kUnnamedObject:
      break;
  }
  return {};
}

}  // namespace parallax::harness
