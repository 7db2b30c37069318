#include "harness/campaign/loop_counts.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace parallax::harness {

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

std::string_view to_string(CoverResult::End end) {
  switch (end) {
    case CoverResult::End::kShown:
      return "all shown";
    case CoverResult::End::kRare:
      return "rarer than epsilon";
    case CoverResult::End::kRunLimit:
      return "max_runs";
    case CoverResult::End::kStopped:
      break;
  }
  return "stopped";
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
