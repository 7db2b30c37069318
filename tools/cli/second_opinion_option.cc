#include "tools/cli/second_opinion_option.h"

#include <fmt/format.h>

#include <utility>

#include "compiler/base/codes/files.h"
#include "harness/campaign/journal.h"
#include "harness/cluster/shell_words.h"
#include "harness/engine/engine_module.h"
#include "harness/engine/world_check.h"
#include "tools/app/closed_loop.h"
#include "tools/app/simulator_factory.h"
#include "tools/cli/limits.h"

namespace parallax::tools {

using harness::EngineKind;

namespace {

constexpr const char* kOption = "--second-opinion";

std::string name_with_version(const harness::SimulatorInfo& info) {
  return info.version.empty() ? info.name : info.name + " " + info.version;
}

}  // namespace

void add_opinion_options(OptionTable& command, OpinionOptions& options) {
  command
      .option(kOption, options.other,
              "Repeat discrepancies, and some clean runs, with another engine or simulator")
      .details(
          "From the same starts: ode, mujoco, bullet, or the command that starts another "
          "simulator.")
      .named_value("ENGINE|COMMAND");
  command
      .option("--second-opinion-runs", options.clean,
              "Number of clean simulations that --second-opinion repeats")
      .check(WholeNumber{0, 1'000'000})
      .needs(kOption)
      .show_default();
}

base::Result<std::unique_ptr<OpinionOfRun>> OpinionOfRun::of(const OpinionOptions& options,
                                                             const ScenarioModel& loaded,
                                                             Invocation& invocation) {
  if (options.other.empty()) return std::unique_ptr<OpinionOfRun>();
  std::unique_ptr<OpinionOfRun> out(new OpinionOfRun(options, loaded, invocation));
  out->other_.scenario.starts = harness::Starts::kUniform;
  const auto engine = harness::kEngineWords.find(options.other);
  const auto chosen = engine ? out->choose_engine(*engine) : out->choose_command();
  if (!chosen) return invocation.sink().already_reported();
  return out;
}

base::Status OpinionOfRun::choose_engine(EngineKind engine) {
  auto& sink = invocation_.sink();
  auto& scenario = other_.scenario;
  const auto refuse = [&](const std::string& why) {
    return sink.error_about(codes::kUsage, fmt::format("{} {}", kOption, options_.other), why);
  };
  if (!loaded_.scenario.simulator.is_built_in()) {
    return refuse("the scenario has a simulator of its own, whose world no engine here knows");
  }
  if (loaded_.scenario.simulator.engine == engine) {
    return refuse("the scenario is simulated by this engine already; name another one");
  }
  if (!harness::has_engine(engine)) return refuse(harness::why_no_engine(engine));
  scenario.simulator.engine = scenario.world.engine = engine;
  const auto problems = harness::check_world(scenario.world);
  if (!problems.empty()) {
    return refuse(fmt::format("world/{} {}", problems.front().path, problems.front().message));
  }
  std::vector<std::string> worker = {"/proc/self/exe", "worker", "--engine", options_.other};
  if (invocation_.form().allow_outside) worker.emplace_back("--allow-outside");
  make_ = simulator_factory(other_, worker, stop_flag());
  return base::Unit{};
}

base::Status OpinionOfRun::choose_command() {
  auto& simulator = other_.scenario.simulator;
  auto split = harness::split_shell_words(options_.other);
  if (!split.fault.empty() || split.words.empty()) {
    return invocation_.sink().error_about(
        codes::kUsage, kOption,
        split.fault.empty()
            ? std::string("it names nobody; it takes ode, mujoco, bullet or a command")
            : fmt::format("{} (byte {})", split.fault, split.fault_at + 1));
  }
  simulator = harness::SimulatorSpec();
  simulator.source = other_.scenario.actions_source;
  simulator.command = std::move(split.words);
  // Who types a command permits it (docs/reference/trust.md).
  make_ = simulator_factory(other_, {}, stop_flag(), {"/proc/self/exe", "supervise", "--"});
  return base::Unit{};
}

harness::SampleListener OpinionOfRun::listener(harness::SampleListener next) {
  return [this, next = std::move(next)](harness::SampleRow row) {
    auto kept = row;
    kept.start.clear();
    kept.margins.clear();
    rows_.push_back(std::move(kept));
    if (next) next(std::move(row));
  };
}

base::Result<bool> OpinionOfRun::start(const runtime::Symbols& symbols,
                                       const harness::CampaignOptions& campaign) {
  run_dir_ = campaign.run_dir;
  seed_ = campaign.seed;
  bench_ = std::make_unique<harness::SimulatorBench>(
      other_.scenario, *symbols, make_,
      harness::TrialOptions{campaign.seed, campaign.jobs, campaign.stop},
      [](const harness::SampleRecord&) {}, invocation_.sink());
  return bench_->start();
}

template <typename Ask>
base::Status OpinionOfRun::ask_with(harness::CampaignResult& result, const Ask& ask) {
  auto& sink = invocation_.sink();
  if (result.interrupted || result.failed || !result.journal_open) return base::Unit{};
  const auto journal = harness::read_journal(run_dir_, invocation_.files(), sink);
  if (!journal) return sink.already_reported();
  harness::SecondOpinion opinion;
  opinion.first = name_with_version(result.simulator);
  opinion.other = name_with_version(bench_->simulator());
  opinion.clean_asked = options_.clean;
  Asked answered = ask(harness::opinion_questions(rows_, journal->samples, options_.clean));
  bench_->close();
  if (!answered) return sink.already_reported();
  if (!*answered) {
    invocation_.remark("interrupted before the second opinion was complete: none is given");
    return base::Unit{};
  }
  opinion.opinions = **std::move(answered);
  result.second_opinion = std::make_shared<const harness::SecondOpinion>(std::move(opinion));
  return base::Unit{};
}

base::Status OpinionOfRun::ask(harness::TraceFeed& feed, harness::CampaignResult& result) {
  harness::TracesOfRun traces;
  for (const auto& trace : result.traces) {
    const auto number = trace.trace->number;
    traces.emplace(std::pair(number, 0), trace.trace);
    for (const auto& [state, counts] : trace.starts.states) {
      if (counts.trace) traces.emplace(std::pair(number, state), counts.trace);
    }
  }
  return ask_with(result, [&](std::vector<harness::OpinionQuestion> questions) {
    return harness::opinions_on_traces(other_.scenario, *bench_, feed, traces, std::move(questions),
                                       invocation_.sink());
  });
}

base::Status OpinionOfRun::ask_about_executions(harness::CampaignResult& result) {
  return ask_with(result, [&](std::vector<harness::OpinionQuestion> questions) -> Asked {
    const auto loop = ClosedLoop::make(loaded_, invocation_);
    if (!loop) return invocation_.sink().already_reported();
    return harness::opinions_on_executions(other_.scenario, *bench_, **loop, seed_,
                                           std::move(questions), invocation_.sink());
  });
}

}  // namespace parallax::tools
