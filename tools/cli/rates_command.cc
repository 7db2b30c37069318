#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "harness/campaign/rare_rates.h"
#include "harness/campaign/rates.h"
#include "harness/campaign/row_statistics.h"
#include "harness/report/report.h"
#include "tools/app/evidence.h"
#include "tools/app/rates_identity.h"
#include "tools/app/scenario_check.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_feed.h"
#include "tools/cli/command.h"
#include "tools/cli/launcher_options.h"
#include "tools/cli/limits.h"
#include "tools/cli/sample_output.h"
#include "tools/cli/shared_options.h"
#include "tools/page/rates_page.h"

namespace parallax::tools {
namespace {

constexpr FiniteNumber kShare{1e-6, 1.0 - 1e-6};
constexpr std::int64_t kMostRunsUntil = 100'000;
constexpr std::int64_t kRareRuns = 10'000;

struct RateOptions {
  std::string scenario;
  JudgingOptions judging;
  harness::RatesOptions rates;
  std::int64_t runs = 0;  // 0: not given
  std::string method = "counting";
  CommandPermission commands;
  std::string samples, plot;
  bool cause_kinds = false;
  double below = 1.0, above = 0.0;  // of --until-below, --until-above
  double indifference = 0.0;        // 0: not given
  std::vector<std::string> values;  // of --mean
  bool outcomes = false;
  LauncherOptions launcher;
};

base::Status check_plot(const std::string& path, Invocation& invocation) {
  if (path.empty()) return base::Unit{};
  auto& sink = invocation.sink();
  if (!path.ends_with(".html")) {
    return sink.error_about(codes::kUsage, path, "--plot writes a page; end the name in .html");
  }
  return check_replaceable(path, is_earlier_page, invocation.files(), sink);
}

/// The kind of each cause, by all runs of its trace that went wrong in this way or not at all.
void add_cause_kinds(const std::vector<harness::SampleRow>& rows, bool world_is_model,
                     harness::RatesResult& result) {
  for (auto& trace : result.traces) {
    for (auto& rate : trace.causes) {
      std::vector<const harness::State*> starts;
      std::vector<bool> failed;
      for (const auto& row : rows) {
        const std::string_view outcome = row.outcome;
        const bool same = outcome == "discrepancy" && row.cause == rate.cause;
        if (row.trace != trace.number || (!same && outcome != "clean" && outcome != "admitted")) {
          continue;
        }
        starts.push_back(&row.start);
        failed.push_back(same);
      }
      rate.kind = to_string(cause_of(starts, failed, world_is_model).finding.kind);
    }
  }
}

harness::RareEventMethod rare_method(const RateOptions& options) {
  return options.method == "splitting" ? harness::RareEventMethod::kSplitting
                                       : harness::RareEventMethod::kImportance;
}

/// Refuses options about counting runs for an estimate from chosen starts.
base::Status check_method(const RateOptions& options, base::DiagnosticSink& sink) {
  if (options.method == "counting") return base::Unit{};
  const std::pair<const char*, bool> asked[] = {{"--until-width", options.rates.until_width > 0.0},
                                                {"--until-below", options.below < 1.0},
                                                {"--until-above", options.above > 0.0},
                                                {"--indifference", options.indifference > 0.0},
                                                {"--mean", !options.values.empty()},
                                                {"--outcomes", options.outcomes},
                                                {"--cause-kinds", options.cause_kinds},
                                                {"--samples", !options.samples.empty()},
                                                {"--plot", !options.plot.empty()}};
  for (const auto& [name, is_given] : asked) {
    if (!is_given) continue;
    return sink.error_about(codes::kUsage, name,
                            "it is about uniform runs; leave it or --method out");
  }
  const auto least = harness::least_runs(rare_method(options));
  if (options.runs == 0 || options.runs >= least) return base::Unit{};
  return sink.error_about(
      codes::kUsage, "--runs",
      fmt::format("--method {} resolves nothing with fewer than {} runs", options.method, least));
}

/// Sets what ends the runs.
base::Status set_end(const RateOptions& options, harness::RatesOptions& rates,
                     base::DiagnosticSink& sink) {
  const auto refuse = [&](const char* option, const char* why) {
    return sink.error_about(codes::kUsage, option, why);
  };
  if (options.below <= options.above) {
    return refuse("", "--until-above must be less than --until-below");
  }
  const bool has_upper = options.below<1.0, has_lower = options.above> 0.0;
  if (has_upper || has_lower) {
    rates.until_known = {options.above, options.below, rates.confidence};
  }
  if (options.indifference > 0.0) {
    if (has_upper == has_lower) {
      return refuse("--indifference", "give it with either --until-below or --until-above");
    }
    rates.indifference =
        has_upper ? harness::IndifferenceRegion{options.below - options.indifference, options.below,
                                                rates.confidence}
                  : harness::IndifferenceRegion{options.above, options.above + options.indifference,
                                                rates.confidence};
    if (rates.indifference->lower <= 0.0 || rates.indifference->upper >= 1.0) {
      return refuse("--indifference", "it must be smaller, so that the region lies within (0, 1)");
    }
  }
  const bool is_open = rates.until_width > 0.0 || rates.until_known;
  if (is_open && !options.values.empty()) {
    return refuse("--mean",
                  "its intervals are for a fixed number of runs; leave --until-... out, or --mean");
  }
  if (options.runs > 0) {
    rates.runs = options.runs;
  } else if (is_open) {
    rates.runs = kMostRunsUntil;
  }
  return base::Unit{};
}

/// Reports a value of --mean that no run of any trace reported.
base::Status check_values(const RateOptions& options, const std::vector<harness::SampleRow>& rows,
                          const harness::RatesResult& result, base::DiagnosticSink& sink) {
  for (std::size_t i = 0; i < options.values.size(); ++i) {
    const auto is_known = [i](const auto& trace) { return trace.values[i].summary.has_value(); };
    if (result.traces.empty() || !result.complete ||
        std::any_of(result.traces.begin(), result.traces.end(), is_known)) {
      continue;
    }
    const auto names = harness::margin_names(rows);
    return sink.error_about(
        codes::kUsage, "--mean",
        fmt::format("no run reported `{}`; there is `duration`{}{}", options.values[i],
                    names.empty() ? "" : ", and of margins ", fmt::join(names, ", ")));
  }
  return base::Unit{};
}

/// Uses a method for events that are too rare to be counted.
int run_rare(const RateOptions& options, const ScenarioModel& loaded, harness::TraceFeed& traces,
             const harness::SimulatorFactory& simulator, Invocation& invocation) {
  auto rates = options.rates;
  rates.runs = options.runs > 0 ? options.runs : kRareRuns;
  rates.stop = &stop_flag();
  rates.progress = progress_on_terminal(invocation.options());
  const auto result = harness::estimate_rare_rates(loaded.scenario, traces, simulator, rates,
                                                   rare_method(options), invocation.sink());
  if (rates.progress) clear_progress();
  if (!result) return 0;
  if (invocation.options().json) {
    invocation.document(harness::rates_json(*result));
  } else {
    invocation.result(harness::rates_text(*result));
  }
  if (!result->is_answered()) return 4;
  return result->traces.empty() ? 1 : 0;
}

int run_rates(const RateOptions& given, Invocation& invocation) {
  auto options = given;
  if (!check_method(options, invocation.sink())) return 0;
  const auto workers = fleet_of(options.launcher, options.rates.jobs, invocation);
  if (!workers) return 0;
  harness::ScenarioSettings settings;
  auto loaded = load_scenario_model(options.scenario, invocation, {.settings = &settings});
  if (!loaded) return 0;
  apply(options.judging, loaded->scenario);
  const auto& model = loaded->compilation.model;
  if (!model.has_constraints) {
    invocation.sink().error(codes::kNothingToSimulate,
                            base::SourceRange{loaded->scenario.source, 0, 0});
    return 0;
  }
  const auto simulator = permitted_simulator(
      *loaded, options.commands.allow || !options.commands.refuse, invocation, *workers);
  if (!simulator) return 0;
  EnumeratedTraces traces(*loaded, invocation);
  traces.explain_absence_by([&] { return reasons_for_absence(*loaded, invocation); });
  if (options.method != "counting") {
    const int code = run_rare(options, *loaded, traces, *simulator, invocation);
    return report_fleet(*workers, invocation) ? code : 0;
  }
  auto rates = options.rates;
  if (!set_end(options, rates, invocation.sink())) return 0;
  rates.stop = &stop_flag();
  rates.progress = progress_on_terminal(invocation.options());
  SampleOutput samples(options.samples);
  if (!samples.check(invocation) || !check_plot(options.plot, invocation)) return 0;
  if (!options.plot.empty() || options.cause_kinds || !options.values.empty() || options.outcomes) {
    samples.collect();
  }
  rates.on_sample = samples.listener();
  auto result =
      harness::estimate_rates(loaded->scenario, traces, *simulator, rates, invocation.sink());
  if (rates.progress) clear_progress();
  if (!report_fleet(*workers, invocation) || !result || !samples.write(invocation)) return 0;
  add_identity(*loaded, settings, *result);
  if (options.cause_kinds) add_cause_kinds(samples.rows(), loaded->world != nullptr, *result);
  if (options.outcomes) harness::add_outcomes(samples.rows(), *result);
  harness::add_values(samples.rows(), options.values, *result);
  if (!options.plot.empty() &&
      !base::write_output(options.plot, rates_page(*result, samples.rows()), invocation.files(),
                          invocation.sink(), base::TextForm::kMarkup)) {
    return 0;
  }
  if (invocation.options().json) {
    invocation.document(harness::rates_json(*result));
  } else {
    invocation.result(harness::rates_text(*result));
  }
  // The error decides the exit code; what was counted is printed all the same.
  if (!check_values(options, samples.rows(), *result, invocation.sink())) return 0;
  if (!result->complete || !result->is_answered()) return 4;
  return result->traces.empty() ? 1 : 0;
}

}  // namespace

Command rates_command() {
  auto options = std::make_shared<RateOptions>();
  OptionTable command(
      "rates", "How often does each trace go wrong, and why: uniform runs, counted by cause");
  command.footer(
      "Examples:\n"
      "  parallax rates scenarios/kitchen/plan2.yaml --trace 2 --runs 400 --jobs 2\n"
      "  parallax rates scenarios/two_regions/edge.yaml --runs 100 --json\n"
      "  parallax rates scenarios/two_regions/edge.yaml --until-width 0.2\n"
      "  parallax rates scenarios/two_regions/edge.yaml --until-below 0.1 --runs 400\n"
      "  parallax rates edge.yaml --until-below 0.5 --indifference 0.1 --confidence 0.99\n"
      "  parallax rates scenarios/kitchen/plan3.yaml --runs 200 --plot rates.html --samples "
      "rates.csv\n"
      "  parallax rates scenarios/kitchen/plan2.yaml --mean duration --mean goal\n"
      "  parallax rates scenarios/two_regions/edge.yaml --method importance --runs 1000\n"
      "Sample N starts as simulation N of `parallax run` with the same seed does, where a trace "
      "has one initial state.\n"
      "Exit codes: 0 estimated, 1 no trace, 4 stopped before all runs were made, or "
      "--runs did not resolve what was asked.");
  command.option("scenario", options->scenario, "Scenario file (YAML)").required().file({"yaml"});
  command.heading("How many simulations");
  command.option("--trace", options->rates.trace, "Only this trace; default: all")
      .check(WholeNumber{1, 1'000'000});
  command
      .option("--runs", options->runs,
              "Simulations of each trace (300); with --until-..., the most (100,000)")
      .check(WholeNumber{1, 1'000'000});
  command
      .option(
          "--until-width", options->rates.until_width,
          "Go on until the interval of every discrepancy is at most this wide (0.1: ten points)")
      .details(
          "Such intervals hold at every moment, and are wider than others for the same number of "
          "runs.")
      .check(FiniteNumber{0.001, 1.0});
  command
      .option("--until-below", options->below,
              "Go on until the rate of every discrepancy is known to be below or above this")
      .details(
          "With --until-above: or to lie between the two. Known with the confidence of "
          "--confidence.")
      .check(kShare);
  command
      .option("--until-above", options->above,
              "Go on until it is known whether the rate is above this")
      .check(kShare);
  command
      .option("--indifference", options->indifference,
              "With --until-below P: test p >= P against p <= P - D, by Wald's sequential test")
      .details(
          "With --until-above P: p <= P against p >= P + D. Each answer is wrong with a "
          "probability "
          "of at most 1 less --confidence, and in between either may come (the indifference region "
          "of Younes and Simmons 2002). The answer is the one that all results of lost runs would "
          "lead to; where there is none, or --runs end before, it is undecided.")
      .named_value("D")
      .check(FiniteNumber{1e-6, 0.999});
  command
      .option("--method", options->method,
              "How runs are drawn: counting, or for rare discrepancies importance or splitting")
      .details(
          "counting draws starts uniformly. importance and splitting make at most --runs (10,000) "
          "simulations and tell no cause; the interval of importance holds whatever the simulator "
          "does.")
      .check(OneOf{{"counting", "importance", "splitting"}})
      .show_default();
  command.heading("What is counted");
  command.flag("--cause-kinds", options->cause_kinds,
               "Also tell what kind of cause each is: always, region, random or simulator");
  add_judging_options(command, options->judging);
  command
      .option("--mean", options->values,
              "Also tell mean and quantiles of `duration` or a margin, with intervals; repeatable")
      .details(
          "duration is the simulated time of all actions in s. Of a margin the least one of a run "
          "counts; EVENT.NAME is that of one event, numbered from 0. Intervals of quantiles hold "
          "for "
          "any distribution, that of the mean is Student's t. Each holds with --confidence.")
      .named_value("NAME")
      .list(ListForm::kOneEachTime);
  command.flag(
      "--outcomes", options->outcomes,
      "Also list in --json how each run ended, for `diff --gate` of results with equal seeds");
  command.heading("How they run");
  command.option("--confidence", options->rates.confidence, "Confidence of each interval")
      .check(FiniteNumber{0.5, 0.999999})
      .show_default();
  command
      .option("--seed", options->rates.seed,
              "Seed of every random choice; `new`: a fresh one, which is printed")
      .check(SeedNumber{})
      .show_default();
  command.option("-j,--jobs", options->rates.jobs, "Simulations at the same time")
      .check(WholeNumber{1, harness::kMostSlots})
      .show_default()
      .given(options->launcher.jobs_given);
  add_launcher_options(command, options->launcher);
  add_mixed_option(command, options->launcher);
  SampleOutput::add_option(command, options->samples);
  command.heading("What is written");
  command
      .option("--plot", options->plot,
              "Also draw the rates, how they settle, and how they depend on the start: a page "
              "(.html)")
      .file();
  add_command_options(command, options->commands, true);
  return command_of(std::move(command), options, run_rates);
}

}  // namespace parallax::tools
