#include "harness/campaign/asked_traces.h"

#include <fmt/format.h>

#include <utility>

#include "compiler/base/codes/campaigns.h"

namespace parallax::harness {

base::Result<bool> visit_asked_traces(TrialBench& bench, TraceFeed& feed, std::int64_t asked,
                                      const std::string& scenario,
                                      const std::function<base::Result<bool>(CampaignTrace)>& visit,
                                      base::DiagnosticSink& sink) {
  const auto started = bench.start();
  if (!started) return sink.already_reported();
  bool complete = *started;
  std::int64_t last = 0;
  bool seen_all = false;
  while (complete) {
    auto trace = feed.next();
    if (!trace) return sink.already_reported();
    seen_all = !*trace;
    if (seen_all) break;
    const std::int64_t number = last = (*trace)->number;
    if (asked != 0 && number != asked) continue;
    const auto visited = visit(std::move(**trace));
    if (!visited) return sink.already_reported();
    complete = *visited;
    if (number == asked) break;
  }
  bench.close();
  if (seen_all) complete = feed.exploration() != "stopped";
  if (seen_all && complete && last < asked) {
    return sink.error_about(codes::kNoSuchTrace, scenario, asked,
                            last == 0   ? "the scenario has none"
                            : last == 1 ? "the scenario has only one"
                                        : fmt::format("the scenario has {}", last));
  }
  return complete;
}

}  // namespace parallax::harness
