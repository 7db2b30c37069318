#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/write_gate.h"
#include "tools/app/version.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"
#include "tools/learn/learn.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

struct LearnCommandOptions {
  LearnOptions learn;
  std::string folder, output;
  CommandPermission commands;
};

constexpr int kClean = 0, kNotClean = 4;

/// out/learn-STEM, numbered where that is taken.
fs::path learn_folder(const std::string& scenario) {
  const auto stem = "learn-" + fs::path(scenario).stem().string();
  auto out = fs::path("out") / stem;
  std::error_code error;
  for (int i = 2; fs::exists(out, error); ++i)
    out = fs::path("out") / fmt::format("{}-{}", stem, i);
  return out;
}

int run_learn(const LearnCommandOptions& options, Invocation& invocation) {
  auto learn_options = options.learn;
  learn_options.out =
      options.folder.empty() ? learn_folder(learn_options.scenario) : fs::path(options.folder);
  if (options.folder.empty() &&
      !base::check_unnamed_output(learn_options.out, ".", "--out", invocation.sink())) {
    return 0;
  }
  learn_options.tool_version = kVersion;
  learn_options.model_file = options.output;
  learn_options.progress = progress_on_terminal(invocation.options());
  if (std::error_code error; !options.folder.empty() && fs::exists(options.folder, error) &&
                             !fs::is_empty(options.folder, error)) {
    invocation.sink().error_about(codes::kFileNotWritable, options.folder,
                                  "--out needs a folder that is new or empty; name another folder");
    return 0;
  }
  const auto result = learn(
      learn_options,
      [&](const ScenarioModel& loaded) {
        return permitted_simulator(loaded, options.commands.allow || !options.commands.refuse,
                                   invocation);
      },
      invocation);
  if (learn_options.progress) clear_progress();
  if (!result) return 0;
  if (!options.output.empty() &&
      !base::write_output(options.output, result->model, invocation.files(), invocation.sink(),
                          base::TextForm::kExact)) {
    return 0;
  }
  invocation.options().json ? invocation.document(learn_json(*result, learn_options))
                            : invocation.exact_result(result->model);
  if (invocation.options().verbosity > 0) {
    for (const auto& each : result->remarks) invocation.remark(each);
  }
  for (const auto& formula : result->refuted) invocation.remark(refuted_text(formula));
  for (const auto& each : result->contradictions) invocation.remark("left open: " + each);
  for (const auto& each : result->not_learnable) invocation.remark("not learned: " + each);
  if (result->judged_in_closed_loop) invocation.remark(std::string(kJudgedInClosedLoop));
  for (const auto& claim : result->claims) invocation.remark(claim);
  invocation.remark(fmt::format("{}: {} axioms about events from {} simulations (seed {}); {}",
                                result->clean ? "clean" : "not clean, " + result->why,
                                result->axioms, result->simulations, learn_options.seed,
                                learn_options.out.string()));
  return result->clean ? kClean : kNotClean;
}

}  // namespace

Command learn_command() {
  auto options = std::make_shared<LearnCommandOptions>();
  auto& learn = options->learn;
  OptionTable command("learn", "Learn what events do from runs, given the declarations alone");
  command.footer(
      "Examples:\n"
      "  parallax learn scenarios/two_regions/scenario.yaml\n"
      "  parallax learn restock.yaml --explore 100 -o learned.e --out out/learned\n"
      "Exit codes: 0 the scenario's run is clean with the learned model; 4 it is not, or not yet: "
      "the best model so far is printed.");
  command.option("scenario", learn.scenario, "Scenario file (YAML)").required().file({"yaml"});
  command.option("-o,--output", options->output, "Write the learned model to this file, too")
      .file({"e"});
  command
      .option("--out", options->folder,
              "Folder of the model, scenario, log and runs; default out/learn-NAME, numbered")
      .folder();
  command
      .option("--explore", learn.explore,
              "Simulate so many random sequences of the plan's events, too")
      .check(WholeNumber{0, 100'000})
      .show_default();
  command.option("--max-runs,--runs", learn.max_runs, "Simulations in all before giving up")
      .check(WholeNumber{1, 1'000'000})
      .show_default();
  command.option("--seed", learn.seed, "Seed of every random choice")
      .check(WholeNumber{0, kMaxSeed / 2})
      .show_default();
  command.option("-j,--jobs", learn.jobs, "Simulations at the same time")
      .check(WholeNumber{1, 256})
      .show_default();
  add_command_options(command, options->commands, true);
  return command_of(std::move(command), options, run_learn);
}

}  // namespace parallax::tools
