#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/words.h"
#include "compiler/base/write_gate.h"
#include "harness/campaign/campaign.h"
#include "harness/report/report.h"
#include "tools/app/closed_loop.h"
#include "tools/app/earlier_runs.h"
#include "tools/app/kept_inputs.h"
#include "tools/app/own_identity.h"
#include "tools/app/run_coverage.h"
#include "tools/app/scenario_check.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_feed.h"
#include "tools/app/version.h"
#include "tools/cli/command.h"
#include "tools/cli/inputs_keeper.h"
#include "tools/cli/launcher_options.h"
#include "tools/cli/limits.h"
#include "tools/cli/sample_output.h"
#include "tools/cli/second_opinion_option.h"
#include "tools/cli/shared_options.h"
#include "tools/repair/provocation.h"

namespace parallax::tools {
namespace {

/// The folder of a run that names none: out/STEM, or out/STEM-2, ... where a run is there already.
/// Finished work is never overwritten.
std::filesystem::path default_run_folder(const std::filesystem::path& scenario);

/// The newest of those folders, for --resume; the first one if there is none.
std::filesystem::path newest_run_folder(const std::filesystem::path& scenario);

/// out/STEM, out/STEM-2, out/STEM-3, ...
std::filesystem::path numbered(const std::filesystem::path& scenario, int number) {
  const auto stem = scenario.stem().string();
  return std::filesystem::path("out") / (number == 1 ? stem : stem + "-" + std::to_string(number));
}

int first_free(const std::filesystem::path& scenario) {
  int number = 1;
  std::error_code error;
  while (std::filesystem::exists(numbered(scenario, number), error)) ++number;
  return number;
}

std::filesystem::path default_run_folder(const std::filesystem::path& scenario) {
  return numbered(scenario, first_free(scenario));
}

std::filesystem::path newest_run_folder(const std::filesystem::path& scenario) {
  const int free = first_free(scenario);
  return numbered(scenario, free == 1 ? 1 : free - 1);
}

constexpr int kProvokedCode = 1;  // as of a discrepancy

struct RunOptions {
  std::string scenario;
  std::string out;
  std::uint64_t seed = 1;
  std::int64_t jobs = 1;
  bool resume = false;
  bool keep_going = false;
  std::string criterion;
  std::string family;  // empty: as the scenario says
  JudgingOptions judging;
  std::string execution;  // empty: as the scenario says
  std::string starts;     // likewise
  bool until_covered = false;
  double confidence = 0.0;  // 0: as the scenario says
  double epsilon = 0.0;
  std::int64_t max_runs = 0, max_traces = 0;
  std::int64_t search = -1;  // below 0: as the scenario says
  std::string strategy;
  std::string record = "discrepancies";
  std::string hits = "first";
  bool split_initial = false;
  std::string samples;
  std::int64_t provoke = 0;  // 0: nothing is provoked
  OpinionOptions opinion;
  CommandPermission commands;
  LauncherOptions launcher;
};

/// The command line overrides the scenario.
void apply(const RunOptions& options, harness::Scenario& scenario) {
  auto& criterion = scenario.criterion;
  if (!options.criterion.empty()) {
    criterion.kind =
        harness::kCriterionWords.find(options.criterion).value_or(harness::CriterionKind::kPaper);
    if (options.criterion == "paper-literal") criterion.paper = harness::paper_literal();
    if (options.criterion == "paper-repaired") criterion.paper = harness::paper_repaired();
  }
  harness::kFamilyWords.take(options.family, criterion.family);
  apply(options.judging, scenario);
  if (options.confidence > 0) criterion.confidence_level = options.confidence;
  harness::kStartsWords.take(options.starts, scenario.starts);
  if (options.until_covered) scenario.until_covered = true;
  if (options.epsilon > 0) criterion.epsilon = options.epsilon;
  if (options.search >= 0) scenario.search.runs = options.search;
  harness::kSearchStrategies.take(options.strategy, scenario.search.strategy);
  if (options.max_runs > 0) scenario.limits.max_runs = options.max_runs;
  if (options.max_traces > 0) scenario.limits.max_traces = options.max_traces;
}

harness::CampaignOptions campaign_options(const RunOptions& options, const ScenarioModel& loaded,
                                          const Invocation& invocation) {
  harness::CampaignOptions campaign;
  campaign.seed = options.seed;
  campaign.jobs = options.jobs;
  // Runs until everything was covered, whatever is found on the way.
  campaign.keep_going = options.keep_going || loaded.scenario.until_covered;
  campaign.resume = options.resume;
  campaign.all_hits = options.hits == "all";
  // The paper's rule is about one initial state.
  campaign.split_initial =
      options.split_initial || (loaded.scenario.criterion.kind == harness::CriterionKind::kPaper &&
                                loaded.scenario.execution == harness::Execution::kOpenLoop);
  if (!options.out.empty()) {
    campaign.run_dir = options.out;
  } else {
    campaign.run_dir =
        options.resume ? newest_run_folder(options.scenario) : default_run_folder(options.scenario);
  }
  harness::kRecordModes.take(options.record, campaign.record);
  std::error_code error;
  campaign.start_folder = std::filesystem::current_path(error).string();
  campaign.scenario_hash = loaded.sources_hash;
  campaign.tool_version = kVersion;
  // Before anything loads modules that the scenario does not need.
  record_identity(loaded.scenario, campaign);
  campaign.mixed = options.launcher.mixed;
  campaign.stop = &stop_flag();
  campaign.progress = progress_on_terminal(invocation.options());
  return campaign;
}

/// The result of a run, and the solver calls that it took.
struct Ran {
  base::Result<harness::CampaignResult> result;
  std::int64_t solve_calls = 0;
};

Ran run_open(const ScenarioModel& loaded, const harness::SimulatorFactory& simulator,
             const harness::CampaignOptions& campaign, OpinionOfRun* opinion,
             Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto& model = loaded.compilation.model;
  if (!model.has_constraints) {
    return {sink.error(codes::kNothingToSimulate, base::SourceRange{loaded.scenario.source, 0, 0})};
  }
  EnumeratedTraces traces(loaded, invocation,
                          {.all_hits = campaign.all_hits, .split_initial = campaign.split_initial});
  traces.explain_absence_by([&] { return reasons_for_absence(loaded, invocation); });
  if (opinion != nullptr && !opinion->start(traces.symbols(), campaign)) {
    return {sink.already_reported()};
  }
  auto result =
      harness::run_campaign(loaded.scenario, traces, simulator, campaign, invocation.files(), sink);
  if (opinion != nullptr && result && !opinion->ask(traces, *result)) {
    return {sink.already_reported()};
  }
  return {std::move(result), traces.solve_calls()};
}

/// Refuses options about traces for a plan that is executed.
base::Status check_closed(const RunOptions& options, const harness::Scenario& scenario,
                          base::DiagnosticSink& sink) {
  if (scenario.criterion.kind == harness::CriterionKind::kPaper) {
    return sink.error(codes::kCriterionNotOfLoop, base::SourceRange{scenario.source, 0, 0});
  }
  const auto refuse = [&](const char* option, const char* why) {
    return sink.error_about(
        codes::kUsage, option,
        fmt::format("{}; leave it out, or simulate traces with --execution open-loop", why));
  };
  if (options.hits != "first") {
    return refuse("--hits", "in closed loop an execution lasts until the plan ends");
  }
  if (options.split_initial) {
    return refuse("--split-initial", "in closed loop executions begin in every initial state");
  }
  if (scenario.until_covered &&
      scenario.criterion.kind == harness::CriterionKind::kClopperPearson) {
    return refuse("until_covered",
                  "the criterion clopper-pearson has a number of runs that nothing seen decides");
  }
  if (scenario.search.runs > 0) {
    return refuse(options.search > 0 ? "--search" : "search",
                  "in closed loop there is no trace whose starts could be searched");
  }
  if (scenario.initial == harness::Initial::kFirst) {
    return refuse("--execution closed-loop",
                  "`initial: first` is of traces: executions begin in every initial state");
  }
  if (!scenario.match_model) {
    return refuse(options.judging.match == "trace" ? "--match=trace" : "match: trace",
                  "in closed loop there is no trace to hold observations against, only the model");
  }
  return base::Unit{};
}

Ran run_closed(const RunOptions& options, const ScenarioModel& loaded,
               const harness::SimulatorFactory& simulator, const harness::CampaignOptions& campaign,
               OpinionOfRun* opinion, Invocation& invocation) {
  auto& sink = invocation.sink();
  if (!check_closed(options, loaded.scenario, sink)) return {sink.already_reported()};
  auto loop = ClosedLoop::make(loaded, invocation);
  if (!loop) return {sink.already_reported()};
  if (opinion != nullptr && !opinion->start((*loop)->symbols(), campaign)) {
    return {sink.already_reported()};
  }
  auto result = harness::run_loop_campaign(loaded.scenario, **loop, simulator, campaign,
                                           invocation.files(), sink);
  if (opinion != nullptr && result && !opinion->ask_about_executions(*result)) {
    return {sink.already_reported()};
  }
  return {std::move(result), (*loop)->solve_calls()};
}

/// Warns that a clean run used the starts for which a fault was mended.
void warn_of_reused_starts(const harness::CampaignOptions& campaign,
                           const harness::CampaignResult& result, const harness::Scenario& scenario,
                           base::DiagnosticSink& sink) {
  if (result.verdict != harness::CampaignVerdict::kNoDiscrepancy) return;
  const auto earlier = earlier_discrepancies(campaign.run_dir, scenario.name, campaign.seed);
  if (earlier.empty()) return;
  const auto more = earlier.size() - 1;
  const auto name = more == 0 ? earlier.front()
                              : fmt::format("{} (and {} other {})", earlier.front(), more,
                                            base::agreed(more, "run", "runs"));
  sink.warning(codes::kStartsReused, base::SourceRange{scenario.source, 0, 0}, name);
}

/// After the run, performs events that its plan does not perform.
base::Result<std::optional<Provocation>> provoke_after(
    const RunOptions& options, const ScenarioModel& loaded, const std::filesystem::path& folder,
    const std::function<void(const harness::CampaignProgress&)>& progress,
    const harness::CampaignResult& result,
    const std::function<base::Result<harness::SimulatorFactory>(const ScenarioModel&)>& simulator,
    Invocation& invocation) {
  if (options.provoke == 0 || !result.journal_open || result.failed || invocation.stopped()) {
    return std::optional<Provocation>();
  }
  ProvokeOptions asked{options.provoke, options.seed, options.jobs, simulator, progress};
  auto provoked = provoke(loaded, folder, asked, invocation);
  if (progress) clear_progress();
  if (!provoked) return invocation.sink().already_reported();
  return std::optional(*std::move(provoked));
}

/// The result, and what was provoked after it.
void tell(const harness::CampaignResult& result, const std::optional<Provocation>& provoked,
          Invocation& invocation) {
  const bool is_verbose = invocation.options().verbosity > 0;
  if (invocation.options().json) {
    auto document = harness::campaign_json(result, true, is_verbose);
    if (provoked) {
      auto json = base::parse_ordered_json(document);
      json["provoked"] = provocation_json(*provoked);
      document = base::json_text(json);
    }
    return invocation.document(document);
  }
  const harness::ReportStyle style{invocation.color_on(STDOUT_FILENO), is_verbose};
  const auto text =
      is_verbose ? harness::campaign_text(result, style) : harness::campaign_summary(result, style);
  invocation.result(text + (provoked ? provocation_text(*provoked) : ""));
}

int run_scenario(const RunOptions& given, Invocation& invocation) {
  auto& sink = invocation.sink();
  using harness::Execution;
  auto options = given;
  const auto workers = fleet_of(options.launcher, options.jobs, invocation);
  if (!workers) return 0;
  // The file of hosts, which is read first, is not among the run's texts.
  const auto of_places = std::ssize(invocation.files().inputs());
  std::optional<Execution> execution;
  for (const auto one : {Execution::kOpenLoop, Execution::kClosedLoop}) {
    if (options.execution == to_string(one)) execution = one;
  }
  auto loaded =
      load_scenario_model(options.scenario, invocation, {.as_run = true, .execution = execution});
  if (!loaded) return 0;
  apply(options, loaded->scenario);
  if (!options.strategy.empty() && loaded->scenario.search.runs == 0) {
    sink.error_about(codes::kUsage, "--search-strategy", "it is about a search; add --search N");
    return 0;
  }
  if (!options.starts.empty() && loaded->scenario.execution == Execution::kOpenLoop) {
    sink.error_about(codes::kUsage, "--starts",
                     "it is about executions of the plan; add --execution closed-loop");
    return 0;
  }
  const auto& model = loaded->compilation.model;
  // Before it is run, which may take long: the files may change meanwhile.
  const auto& read = invocation.files().inputs();
  auto inputs = packed_inputs(options.scenario, loaded->sources_hash,
                              std::vector<std::string>(read.begin() + of_places, read.end()));
  auto campaign = campaign_options(options, *loaded, invocation);
  if (options.out.empty() && !base::check_unnamed_output(campaign.run_dir, ".", "--out", sink)) {
    return 0;
  }
  const auto simulator_of = [&](const ScenarioModel& of) {
    return permitted_simulator(of, options.commands.allow || !options.commands.refuse, invocation,
                               *workers);
  };
  const auto simulator = simulator_of(*loaded);
  if (!simulator) return 0;
  for (const auto* name : {"report.txt", "report.json", kInputsName.data()}) {
    if (!base::check_output(campaign.run_dir / name, invocation.files(), sink)) return 0;
  }
  SampleOutput samples(options.samples);
  if (!samples.check(invocation)) return 0;
  campaign.on_sample = samples.listener();
  const auto opinion = OpinionOfRun::of(options.opinion, *loaded, invocation);
  if (!opinion) return 0;
  if (*opinion) campaign.on_sample = (*opinion)->listener(std::move(campaign.on_sample));
  const auto progress = campaign.progress;  // as asked for: the keeper listens, too
  InputsKeeper keeper(campaign.run_dir / kInputsName, std::move(inputs), invocation);
  keeper.watch(campaign);
  const bool closed = loaded->scenario.execution == Execution::kClosedLoop;
  auto ran = closed ? run_closed(options, *loaded, *simulator, campaign, opinion->get(), invocation)
                    : run_open(*loaded, *simulator, campaign, opinion->get(), invocation);
  auto& result = ran.result;
  if (progress) clear_progress();
  if (!report_fleet(*workers, invocation) || !result) return 0;
  if (!samples.write(invocation)) return 0;
  result->coverage = coverage_of_run(*loaded, *result, invocation);
  warn_of_reused_starts(campaign, *result, loaded->scenario, sink);
  if (result->journal_open && !harness::write_report(*result, campaign.run_dir, sink)) return 0;
  if (result->journal_open && !keeper.keep()) return 0;
  const auto provoked = provoke_after(options, *loaded, campaign.run_dir, progress, *result,
                                      simulator_of, invocation);
  if (!provoked) return 0;
  tell(*result, *provoked, invocation);
  invocation.remark(fmt::format("{} simulations in {:.1f} s ({:.0f} s simulated)",
                                result->timing.runs_made, result->timing.wall_s,
                                result->timing.simulated_s));
  if (invocation.options().verbosity > 0) {
    invocation.remark(fmt::format("model: {} variables, {} clauses, {} solver calls",
                                  model.variable_count(), model.clauses.size(), ran.solve_calls));
  }
  if (result->journal_open) {
    invocation.remark(fmt::format("report: {}", (campaign.run_dir / "report.txt").string()));
  }
  // The error decides the exit code.
  if (result->failed) return 0;
  const int code = harness::exit_code(*result);
  return code == 0 && *provoked && !(*provoked)->is_clean() ? kProvokedCode : code;
}

}  // namespace

Command run_command() {
  auto options = std::make_shared<RunOptions>();
  OptionTable command("run",
                      "The whole loop: trace, sample, simulate, compare, confidence, next trace");
  command.footer(
      "Examples:\n"
      "  parallax run scenarios/two_regions/scenario.yaml\n"
      "  parallax run edge.yaml --jobs 2 --seed 7 --out out/edge7\n"
      "  parallax run edge.yaml --execution closed-loop\n"
      "  parallax run edge.yaml --record all\n"
      "  parallax run edge.yaml --seed 7 --out out/edge7 --resume\n"
      "  parallax run edge.yaml --keep-going --samples edge.csv\n"
      "  parallax run edge.yaml --search 40\n"
      "  parallax run edge.yaml --provoke 100\n"
      "  parallax run edge.yaml --second-opinion bullet\n"
      "  parallax run edge.yaml --launcher 'srun -n1 -c1' --jobs 32\n"
      "Exit codes: 0 no discrepancy, 1 discrepancy, also a provoked one, 4 inconclusive, as "
      "without "
      "a trace.");
  command.option("scenario", options->scenario, "Scenario file (YAML)").required().file({"yaml"});
  command.heading("The run");
  command.option("--out", options->out, "Run folder; default out/NAME, numbered if taken").folder();
  command
      .option("--seed", options->seed,
              "Seed of every random choice; `new`: a fresh one, which is printed")
      .check(SeedNumber{})
      .show_default();
  command.option("-j,--jobs", options->jobs, "Simulations at the same time")
      .check(WholeNumber{1, harness::kMostSlots})
      .show_default()
      .given(options->launcher.jobs_given);
  add_launcher_options(command, options->launcher);
  add_mixed_option(command, options->launcher);
  command.flag("--resume", options->resume, "Continue the run in the run folder");
  command
      .flag("--keep-going", options->keep_going,
            "Go on after a discrepancy, with the next trace or execution")
      .details("In closed loop it also counts how often each cause occurs.");
  command
      .flag("--until-covered", options->until_covered,
            "Go on until every trace was simulated, or every behaviour seen. Includes --keep-going")
      .details(
          "In closed loop: until executions showed every behaviour of plan and model, or those "
          "that they did not show are rarer than epsilon.");
  command.heading("What is claimed");
  command.option("--criterion", options->criterion, "When a trace has been tried enough")
      .details(
          "paper is the regression rule of Meywerk et al.; with --verbose it prints b, sigma and "
          "the "
          "interval of each final parameter.")
      .check(OneOf{{"clean-runs", "anytime", "clopper-pearson", "paper", "paper-literal",
                    "paper-repaired"}});
  command
      .option("--family", options->family,
              "Claim for all-traces together (the default) or per-trace")
      .details(
          "all-traces: one sentence about all traces, which share the error probability. "
          "per-trace: a claim for each trace by itself, in fewer runs.")
      .check(OneOf{{"all-traces", "per-trace"}});
  add_judging_options(command, options->judging);
  command.heading("What is simulated");
  command
      .option("--execution", options->execution,
              "Simulate open-loop (events of traces) or closed-loop (the plan itself)")
      .details("In closed loop the plan goes on by what the simulator reports.")
      .check(one_of(harness::kExecutions));
  command
      .option("--starts", options->starts,
              "Closed loop: initial states are uniform, or guided to behaviour not yet seen")
      .details("guided: first where the model has a path that no execution has taken yet.")
      .check(one_of(harness::kStartsWords));
  command.heading("What is claimed");
  command.option("--confidence", options->confidence, "Confidence level C of the claim")
      .check(FiniteNumber{0.5, 0.999999});
  command.option("--epsilon", options->epsilon, "Discrepancy probability to exclude")
      .check(FiniteNumber{1e-6, 0.5});
  command.option("--max-runs", options->max_runs, "Simulations per trace before giving up")
      .check(WholeNumber{1, 1'000'000});
  command.heading("Search");
  command
      .option("--search", options->search,
              "Spend N simulations per trace on guided search before the certification runs")
      .details(
          "Falsification: starts are proposed by how near earlier ones came to a discrepancy. "
          "Nothing is claimed from these runs.")
      .check(WholeNumber{0, harness::kMaxSearchRuns});
  command
      .option("--search-strategy", options->strategy,
              "How the search proposes starts; portfolio is the default")
      .details(
          "portfolio, uniform, sobol, boundary, cross-entropy, expected-improvement or descent.")
      .check(OneOf{{"portfolio", "uniform", "sobol", "boundary", "cross-entropy",
                    "expected-improvement", "descent"}});
  command.heading("Traces");
  command.option("--max-traces", options->max_traces, "Traces that are simulated at most")
      .check(WholeNumber{1, 1'000'000'000});
  command.heading("What is kept");
  command
      .option("--record", options->record,
              "Record the motion of all simulations, of discrepancies, or of none")
      .details("discrepancies also keeps three clean simulations of each trace.")
      .check(OneOf{{"all", "discrepancies", "none"}})
      .show_default();
  SampleOutput::add_option(command, options->samples);
  command.heading("Traces");
  add_hits_option(command, options->hits);
  command.flag("--split-initial", options->split_initial,
               "Make each initial state a trace of its own, with its own claim");
  command.heading("Events beyond the plan");
  command
      .option("--provoke", options->provoke,
              "Then perform up to N events that the model allows and the plan does not perform")
      .details(
          "Each in a state that a run came to. An event that the world refuses, or that ends "
          "otherwise than the model says, gives exit code 1: the model permits too much.")
      .check(WholeNumber{1, 1'000'000});
  command.heading("Second opinion");
  add_opinion_options(command, options->opinion);
  add_command_options(command, options->commands, true);
  return command_of(std::move(command), options, run_scenario);
}

}  // namespace parallax::tools
