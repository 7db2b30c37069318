#include "tools/repair/plan_runs.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

#include "compiler/base/temporary_folder.h"
#include "tools/app/closed_loop.h"
#include "tools/app/own_identity.h"
#include "tools/app/trace_feed.h"
#include "tools/app/version.h"

namespace parallax::tools {
namespace {

constexpr std::int64_t kMostPlanRuns = 5;  // of a trace; enough for what a world leaves open

/// Gives the scenario another model.
bool put_model(ScenarioModel& loaded, const std::string& model, Context& context) {
  auto& scenario = loaded.scenario;
  const bool closed = scenario.execution == harness::Execution::kClosedLoop;
  auto compiled = compile_with_model(scenario, model, scenario.execution, !closed, context);
  if (!compiled) return false;
  loaded.compilation = *std::move(compiled);
  if (closed) scenario.horizon = loaded.compilation.model.horizon;
  return true;
}

}  // namespace

void end_at_refusal(Evidence& seen) {
  const auto failed = std::find_if(seen.steps.begin(), seen.steps.end(),
                                   [](const auto& step) { return step.failed; });
  if (failed == seen.steps.end()) return;
  seen.steps.erase(std::next(failed), seen.steps.end());
  seen.states.resize(std::min(seen.states.size(), seen.steps.size() + 1));
}

base::Result<harness::CampaignResult> run_plan(ScenarioModel& loaded,
                                               harness::CampaignOptions options,
                                               const ExperimentOptions& experiments,
                                               Context& context) {
  auto& sink = context.sink();
  auto& files = context.files();
  const auto simulator = experiments.simulator(loaded);
  if (!simulator) return sink.already_reported();
  std::error_code error;
  options.jobs = experiments.jobs;
  options.start_folder = std::filesystem::current_path(error).string();
  options.scenario_hash = loaded.sources_hash;
  options.tool_version = kVersion;
  record_identity(loaded.scenario, options);
  options.stop = &context.stop();
  options.progress = experiments.progress;
  if (loaded.scenario.execution == harness::Execution::kClosedLoop) {
    auto feed = ClosedLoop::make(loaded, context);
    if (!feed) return sink.already_reported();
    return harness::run_loop_campaign(loaded.scenario, **feed, *simulator, options, files, sink);
  }
  EnumeratedTraces traces(loaded, context,
                          {.all_hits = options.all_hits, .split_initial = options.split_initial});
  return harness::run_campaign(loaded.scenario, traces, *simulator, options, files, sink);
}

std::vector<Evidence> runs_of_plan(ScenarioModel loaded, const std::string& model,
                                   const ExperimentOptions& experiments, Context& context) {
  const base::TemporaryFolder folder("plan-runs");
  if (folder.path().empty()) return {};
  const auto before = context.sink();
  const auto none = [&] {
    context.sink() = before;
    return std::vector<Evidence>();
  };
  if (!put_model(loaded, model, context)) return none();
  loaded.scenario.limits.max_runs = kMostPlanRuns;
  loaded.scenario.search.runs = 0;
  harness::CampaignOptions options;
  options.keep_going = true;
  options.run_dir = folder.path() / "run";
  if (!run_plan(loaded, options, experiments, context)) return none();
  const auto journal = harness::read_journal(options.run_dir, context.files(), context.sink());
  if (!journal) return none();
  const auto paths = observed_paths(loaded, *journal, context);
  if (!paths) return none();
  auto out = evidence_of(*paths, loaded.compilation.model);
  for (auto& seen : out) end_at_refusal(seen);
  context.sink() = before;
  return out;
}

}  // namespace parallax::tools
