#include <memory>
#include <optional>
#include <string>

#include "tools/app/discrepancy.h"
#include "tools/app/file_kind.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"
#include "tools/confirm/confirm.h"

namespace parallax::tools {
namespace {

/// Options of both commands.
struct BorderOptions {
  RunFolderOptions run;
  std::string sample;
  TriedStartsOptions starts;
  double tolerance = 0.0;
  bool has_tolerance = false;
  CommandPermission commands;

  std::optional<double> asked_tolerance() const {
    return has_tolerance ? std::optional(tolerance) : std::nullopt;
  }
};

/// A discrepancy of a run folder with the simulators that repeat it.
struct DiscrepancyAtHand {
  RecordedDiscrepancy found;
  ScenarioModel as_run;
  ConfirmSimulators simulators;
};

/// None: there is no discrepancy, or none that the model excludes; `words` says so.
base::Result<std::optional<DiscrepancyAtHand>> load(const BorderOptions& options,
                                                    std::string& words, Invocation& invocation) {
  const auto& sink = invocation.sink();
  std::optional<DiscrepancyAtHand> none;
  if (!parse_sample_option(options.sample, invocation.sink()) ||
      !expect_kind(options.run.folder, {FileKind::kRun}, "the folder of a run", invocation)) {
    return sink.already_reported();
  }
  auto found = load_discrepancy(options.run, options.sample, invocation);
  if (!found) return sink.already_reported();
  if (!*found) {
    words = "The run found no discrepancy: there is nothing to repeat.";
    return none;
  }
  if (!(*found)->parting) {
    words = "The model admits what the simulation showed: there is nothing to repeat.";
    return none;
  }
  // Uses the name under which the scenario was found, which a remark has told.
  const auto folder = found_again(options.run.folder, (*found)->loaded);
  auto as_run =
      load_recorded_scenario(folder, *(*found)->journal.header, ScenarioUse::kRun, invocation);
  if (!as_run) return sink.already_reported();
  auto simulator = permitted_simulator(*as_run, options.commands.allow, invocation);
  if (!simulator) return sink.already_reported();
  // Judged as the run was; executions begin where the discrepancy did.
  auto& scenario = as_run->scenario;
  scenario.compare = recorded_comparison(*(*found)->journal.header).value_or(scenario.comparison());
  scenario.starts = harness::Starts::kUniform;
  ConfirmSimulators simulators{*std::move(simulator), half_step_simulator(*as_run, invocation)};
  return std::optional(
      DiscrepancyAtHand{**std::move(found), *std::move(as_run), std::move(simulators)});
}

int nothing(const std::string& words, Invocation& invocation) {
  invocation.options().json ? invocation.document(R"({"status": "ok", "verdict": "no-discrepancy"})"
                                                  "\n")
                            : invocation.result(words + '\n');
  return 0;
}

/// The options of one command with those that both have.
template <typename Options>
Options as_asked(Options options, const BorderOptions& border, const Invocation& invocation) {
  options.starts = border.starts;
  options.starts.progress = progress_on_terminal(invocation.options());
  options.tolerance = border.asked_tolerance();
  return options;
}

void end_progress(const TriedStartsOptions& starts) {
  if (starts.progress) clear_progress();
}

struct ConfirmCommandOptions {
  BorderOptions border;
  ConfirmOptions confirm;
};

int confirm(const ConfirmCommandOptions& options, Invocation& invocation) {
  std::string words;
  const auto at_hand = load(options.border, words, invocation);
  if (!at_hand) return 0;
  if (!*at_hand) return nothing(words, invocation);
  const auto asked = as_asked(options.confirm, options.border, invocation);
  const auto& folder = options.border.run.folder;
  const auto told = confirm_discrepancy(folder, (*at_hand)->found, (*at_hand)->as_run,
                                        (*at_hand)->simulators, asked, invocation);
  end_progress(asked.starts);
  if (!told) return 0;
  invocation.options().json ? invocation.document(confirm_json(*told))
                            : invocation.result(confirm_text(*told, folder));
  const auto is = told->verdict();
  const bool stands = is == ConfirmVerdict::kConfirmed || is == ConfirmVerdict::kPartly;
  return told->finished() && stands ? 1 : 4;
}

struct ThresholdCommandOptions {
  BorderOptions border;
  ThresholdOptions threshold;
};

int threshold(const ThresholdCommandOptions& options, Invocation& invocation) {
  std::string words;
  const auto at_hand = load(options.border, words, invocation);
  if (!at_hand) return 0;
  if (!*at_hand) return nothing(words, invocation);
  const auto asked = as_asked(options.threshold, options.border, invocation);
  const auto& folder = options.border.run.folder;
  const auto told = find_threshold(folder, (*at_hand)->found, (*at_hand)->as_run,
                                   (*at_hand)->simulators.usual, asked, invocation);
  end_progress(asked.starts);
  if (!told) return 0;
  invocation.options().json ? invocation.document(threshold_json(*told))
                            : invocation.result(threshold_text(*told, folder));
  if (!told->finished()) return 4;
  invocation.answered();
  return 0;
}

/// Options that both commands have.
void add_border_options(OptionTable& command, BorderOptions& options) {
  command.option("run_dir", options.run.folder, "Folder of a run").required().folder();
  command.option("--sample", options.sample, "TRACE.SAMPLE; default: the first discrepancy");
  command
      .option("--tolerance", options.tolerance,
              "Precision of borders, in the parameter's unit; default: a hundredth of its range")
      .check(Positive{})
      .given(options.has_tolerance);
  command
      .option("--runs", options.starts.runs,
              "Simulate at most so many starts, those on record included")
      .check(WholeNumber{1, 1'000'000})
      .show_default();
  command.option("-j,--jobs", options.starts.jobs, "Simulations at the same time")
      .check(WholeNumber{1, 256})
      .show_default();
  add_recorded_scenario_option(command, options.run.scenario);
  add_command_options(command, options.commands, false);
}

}  // namespace

Command confirm_command() {
  auto options = std::make_shared<ConfirmCommandOptions>();
  OptionTable command("confirm",
                      "Repeat a run's discrepancy with the same seed, others and half the step, "
                      "and say which parameters of its start matter");
  command.footer(
      "Examples:\n"
      "  parallax confirm out/edge --jobs 2\n"
      "  parallax confirm out/edge --sample 1.4 --repeats 20 --runs 100\n"
      "Exit codes: 1 the discrepancy is confirmed, at least in most repetitions, 0 there is none,\n"
      "4 it is in doubt, or --runs ended before all was known.");
  add_border_options(command, options->border);
  command
      .option("--repeats", options->confirm.repeats,
              "Repetitions of the failing start with other seeds, and with half the step")
      .details("They do not count in --runs.")
      .check(WholeNumber{0, 10'000})
      .show_default();
  return command_of(std::move(command), options, confirm);
}

Command threshold_command() {
  auto options = std::make_shared<ThresholdCommandOptions>();
  OptionTable command("threshold",
                      "Find where along one parameter of its start a run's discrepancy ends");
  command.footer(
      "Examples:\n"
      "  parallax threshold out/edge --parameter box.x\n"
      "  parallax threshold out/plan1 --parameter milk1.mass --tolerance 0.001 --points 9\n"
      "Exit codes: 0 the borders are known as well as was asked for, or none was seen; 4 --runs\n"
      "ended before, or there are values between that are no start.");
  add_border_options(command, options->border);
  command
      .option("--parameter", options->threshold.parameter,
              "Of the start, as reports name it: box.x, milk1.mass")
      .required();
  command
      .option("--points", options->threshold.points,
              "Look at so many values from end to end, before borders are narrowed down")
      .check(WholeNumber{2, 10'000})
      .show_default();
  return command_of(std::move(command), options, threshold);
}

}  // namespace parallax::tools
