#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/subprocess.h"
#include "harness/campaign/campaign.h"
#include "harness/report/report.h"
#include "parallax/parallax.h"
#include "tools/app/closed_loop.h"
#include "tools/app/kept_inputs.h"
#include "tools/app/own_identity.h"
#include "tools/app/scenario_model.h"
#include "tools/app/simulator_factory.h"
#include "tools/app/trace_feed.h"
#include "tools/app/version.h"
#include "tools/shared/messages.h"

namespace parallax::api {

Simulator::Simulator() = default;
Simulator::~Simulator() = default;

namespace {

harness::SimStatus in_house(Status status) {
  switch (status) {
    case Status::kOk:
      return harness::SimStatus::kOk;
    case Status::kFailed:
      return harness::SimStatus::kFailed;
    case Status::kTruncated:
      return harness::SimStatus::kTruncated;
    case Status::kInvalidStart:
      return harness::SimStatus::kInvalidStart;
    case Status::kUnsupported:
      return harness::SimStatus::kUnsupported;
    case Status::kLost:
      break;
  }
  return harness::SimStatus::kLost;
}

/// A client's simulator as campaigns know them.
class Guest final : public harness::Simulator {
 public:
  explicit Guest(std::unique_ptr<api::Simulator> own) : own_(std::move(own)) {}

  harness::SimulatorInfo info() override {
    const auto said = own_->info();
    harness::SimulatorInfo out;
    out.name = said.name;
    out.version = said.version;
    out.determinism = said.repeats_bitwise ? "bitwise" : "none";
    out.seeds = true;
    for (const auto& one : said.variables) {
      out.parameters.push_back({.name = one.name, .unit = one.unit, .settable = one.settable});
    }
    out.actions = said.actions;
    out.timestep_s = said.timestep_s;
    return out;
  }
  harness::Outcome reset(const harness::State& initial, std::uint64_t seed) override {
    return outcome(own_->reset(initial, seed));
  }
  harness::Outcome act(std::string_view action, const harness::State& arguments,
                       double sim_time_limit_s) override {
    return outcome(own_->act(action, arguments, sim_time_limit_s));
  }
  harness::State observe() override { return own_->observe(); }

 private:
  static harness::Outcome outcome(Outcome said) {
    harness::Outcome out;
    out.status = in_house(said.status);
    out.reason = std::move(said.reason);
    out.sim_time_s = said.sim_time_s;
    out.margins = std::move(said.margins);
    out.object = std::move(said.object);
    return out;
  }

  std::unique_ptr<api::Simulator> own_;
};

harness::SimulatorFactory simulator_of(const RunOptions& options,
                                       const tools::ScenarioModel& loaded,
                                       const std::atomic<bool>& stop, tools::Context& context) {
  if (options.simulator) {
    return [make = options.simulator]() -> std::unique_ptr<harness::Simulator> {
      auto own = make();
      if (!own) throw Failure("RunOptions::simulator made no simulator", {});
      return std::make_unique<Guest>(std::move(own));
    };
  }
  const auto& spec = loaded.scenario.simulator;
  if (!spec.command.empty() && !options.allow_commands) {
    context.sink().error(codes::kCommandNotPermitted, spec.source,
                         base::command_text(spec.command));
    fail(context);
  }
  return tools::simulator_factory(loaded, {options.program, "worker"}, stop,
                                  {options.program, "supervise", "--"});
}

Verdict verdict_of(harness::CampaignVerdict verdict) {
  switch (verdict) {
    case harness::CampaignVerdict::kNoDiscrepancy:
      return Verdict::kNoDiscrepancy;
    case harness::CampaignVerdict::kDiscrepancy:
      return Verdict::kDiscrepancy;
    case harness::CampaignVerdict::kInconclusive:
      break;
  }
  return Verdict::kInconclusive;
}

Run told(const harness::CampaignResult& result, const tools::Context& context) {
  Run out;
  out.verdict = verdict_of(result.verdict);
  out.claim = result.claim;
  out.exploration = result.exploration;
  out.bounds = result.bounds;
  out.traces = static_cast<std::int64_t>(result.traces.size());
  out.simulations = result.simulations;
  for (const auto& trace : result.traces) out.lost += trace.lost;
  for (const auto& one : result.discrepancies) {
    Discrepancy found;
    found.trace = one.trace;
    found.sample = one.sample;
    found.timepoint = static_cast<int>(one.first_divergence);
    found.cause = one.cause.text;
    for (const auto& fluent : one.first) found.fluents.push_back(fluent.fluent);
    found.start = one.record.initial;
    out.discrepancies.push_back(std::move(found));
  }
  out.summary = harness::campaign_summary(result, {});
  out.report_json = harness::campaign_json(result, false);
  out.warnings = messages_of(context);
  return out;
}

}  // namespace

Run run(const std::string& scenario, const RunOptions& options) {
  std::atomic<bool> own_stop{false};
  tools::Context context({}, own_stop);
  const auto refuse = [&](const char* option, const char* why) {
    context.sink().error_about(codes::kUsage, option, why);
    fail(context);
  };
  if (options.folder.empty()) refuse("RunOptions::folder", "it names the folder of the run");
  if (options.jobs < 1 || options.jobs > 256) refuse("RunOptions::jobs", "it is from 1 to 256");
  if (options.max_runs < 0) refuse("RunOptions::max_runs", "it is not negative");
  auto loaded = tools::load_scenario_model(scenario, context, {.as_run = true});
  if (!loaded) fail(context);
  const auto inputs =
      tools::packed_inputs(scenario, loaded->sources_hash, context.files().inputs());
  const auto& stop = options.stop != nullptr ? *options.stop : own_stop;
  const auto simulator = simulator_of(options, *loaded, stop, context);
  if (options.max_runs > 0) loaded->scenario.limits.max_runs = options.max_runs;

  harness::CampaignOptions campaign;
  campaign.seed = options.seed;
  campaign.jobs = options.jobs;
  campaign.keep_going = options.keep_going || loaded->scenario.until_covered;
  campaign.resume = options.resume;
  const bool is_closed = loaded->scenario.execution == harness::Execution::kClosedLoop;
  // The paper's rule is about one initial state.
  campaign.split_initial =
      !is_closed && loaded->scenario.criterion.kind == harness::CriterionKind::kPaper;
  campaign.run_dir = options.folder;
  std::error_code error;
  campaign.start_folder = std::filesystem::current_path(error).string();
  campaign.scenario_hash = loaded->sources_hash;
  campaign.tool_version = tools::kVersion;
  // The program is the client's, so that its build says nothing.
  campaign.arithmetic = tools::own_arithmetic(loaded->scenario.simulator.engine);
  campaign.stop = &stop;
  if (options.progress) {
    campaign.progress = [tell = options.progress](const harness::CampaignProgress& now) {
      tell({now.trace, now.done, now.needed});
    };
  }
  for (const auto* name : {"report.txt", "report.json", tools::kInputsName.data()}) {
    if (!base::check_output(campaign.run_dir / name, context.files(), context.sink()))
      fail(context);
  }

  auto result = [&]() -> base::Result<harness::CampaignResult> {
    if (is_closed) {
      auto loop = tools::ClosedLoop::make(*loaded, context);
      if (!loop) return context.sink().already_reported();
      return harness::run_loop_campaign(loaded->scenario, **loop, simulator, campaign,
                                        context.files(), context.sink());
    }
    if (!loaded->compilation.model.has_constraints) {
      return context.sink().error(codes::kNothingToSimulate,
                                  base::SourceRange{loaded->scenario.source, 0, 0});
    }
    tools::EnumeratedTraces traces(*loaded, context, {.split_initial = campaign.split_initial});
    return harness::run_campaign(loaded->scenario, traces, simulator, campaign, context.files(),
                                 context.sink());
  }();
  if (!result) fail(context);
  if (result->journal_open) {
    if (!harness::write_report(*result, campaign.run_dir, context.sink())) fail(context);
    if (!inputs.empty() && !base::write_output(campaign.run_dir / tools::kInputsName, inputs,
                                               context.files(), context.sink()))
      fail(context);
  }
  if (result->failed) fail(context);
  auto out = told(*result, context);
  out.scenario_hash = loaded->sources_hash;
  return out;
}

}  // namespace parallax::api
