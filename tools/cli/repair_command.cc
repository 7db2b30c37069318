#include <fmt/format.h>

#include <memory>

#include "compiler/base/codes/files.h"
#include "tools/cli/command.h"
#include "tools/cli/launcher_options.h"
#include "tools/cli/shared_options.h"
#include "tools/repair/apply.h"
#include "tools/repair/experiments.h"
#include "tools/repair/repair.h"
#include "tools/repair/repair_loop.h"

namespace parallax::tools {
namespace {

constexpr std::int64_t kUsualRuns = -1;

struct RepairCommandOptions {
  RepairOptions repair;
  std::int64_t apply = 0;  // 0: nothing is written
  std::int64_t runs = kUsualRuns;
  ExperimentOptions experiments;
  CommandPermission commands;
  bool loop = false;
  std::string out;
  std::int64_t rounds = 8;
  LauncherOptions launcher;
};

constexpr int kProposals = 1, kNoneFound = 4;

/// Reports the files that were written, and further effects of that.
void tell_written(const std::vector<ChangedFile>& files, const std::vector<std::string>& world,
                  const Context& context) {
  for (const auto& file : files) context.remark("wrote " + file.name);
  for (const auto& name : world) {
    context.remark(
        fmt::format("the world reads {}, too, and was changed with the model: that a run after it "
                    "is clean says "
                    "nothing; give the world files of its own",
                    name));
  }
}

/// Admits the files that --apply may change: those of the current project, and those beside a
/// scenario that the user named.
base::WriteGate write_gate(const RunFolderOptions& folder, const Invocation& invocation) {
  base::WriteGate gate(invocation.form().allow_outside);
  if (!folder.scenario.empty()) gate.admit_beside(folder.scenario);
  return gate;
}

int apply(const RepairResult& result, const RepairCommandOptions& options, Invocation& invocation) {
  const auto number = options.apply;
  const auto count = static_cast<std::int64_t>(result.proposals.size());
  if (number > count) {
    invocation.sink().error_about(
        codes::kUsage, "--apply",
        fmt::format("there is no proposal {}; there are {}", number, count));
    return 0;
  }
  const auto& proposal = result.proposals[static_cast<std::size_t>(number) - 1];
  if (!apply_proposal(proposal, write_gate(options.repair.folder, invocation), invocation))
    return 0;
  tell_written(proposal.files, proposal.read_by_world, invocation);
  if (const auto by = refutation(proposal, result)) {
    invocation.remark("the model is now refuted by " + *by);
  }
  if (proposal.agrees_less) {
    invocation.remark(fmt::format(
        "the model agreed with {} of the runs before, and with {} now: other proposals fit better",
        result.runs - result.failed, proposal.verdict.runs_whole));
  }
  return 0;
}

int exit_code(LoopEnd end) {
  switch (end) {
    case LoopEnd::kClean:
    case LoopEnd::kNothing:
    case LoopEnd::kFailed:  // the error decides
      return 0;
    case LoopEnd::kTie:
    case LoopEnd::kPlanAtFault:
    case LoopEnd::kRefuted:
    case LoopEnd::kRounds:
      return kProposals;
    case LoopEnd::kNone:
    case LoopEnd::kInconclusive:
    case LoopEnd::kStopped:
      break;
  }
  return kNoneFound;
}

/// Round after round in copies; with --apply the user's files are changed at last.
int repair_loop(const RepairCommandOptions& options, const ExperimentOptions& experiments,
                Invocation& invocation) {
  const auto& given = options.repair;
  const auto refuse = [&](const char* option, const std::string& why) {
    invocation.sink().error_about(codes::kUsage, option, why);
    return 0;
  };
  if (options.out.empty()) {
    return refuse("--loop",
                  "add --out DIR: a new folder, which gets the copies, the runs and the "
                  "log of the rounds");
  }
  if (given.other_model) {
    return refuse("--other-model", "--loop begins with the model that was run; leave it out");
  }
  if (options.apply > 1) {
    return refuse("--apply", "--loop takes the first proposal of each round: --apply 1");
  }
  const auto loop = repair_in_rounds({given, experiments, options.out, options.rounds}, invocation);
  if (experiments.progress) clear_progress();
  if (!loop) return 0;
  invocation.options().json ? invocation.document(loop_json(*loop))
                            : invocation.result(loop_text(*loop));
  if (options.apply == 1 && (exit_code(loop->end) != 0 || loop->end == LoopEnd::kFailed)) {
    invocation.remark("nothing was written into the files: the rounds did not end clean; " +
                      options.out + "/repair.patch has what they changed");
  } else if (options.apply == 1) {
    Proposal all;
    all.files = loop->files;
    if (!apply_proposal(all, write_gate(given.folder, invocation), invocation)) return 0;
    tell_written(all.files, loop->read_by_world, invocation);
  }
  return exit_code(loop->end);
}

int repair(const RepairCommandOptions& options, Invocation& invocation) {
  auto repair = options.repair;
  repair.plan = true;
  if (repair.limit != 0) repair.limit = std::max(repair.limit, options.apply);
  auto experiments = options.experiments;
  if (options.runs != kUsualRuns) experiments.runs = options.runs;
  const auto workers = fleet_of(options.launcher, experiments.jobs, invocation);
  if (!workers) return 0;
  experiments.allow_commands = options.commands.allow;
  experiments.simulator = [&](const ScenarioModel& loaded) {
    return permitted_simulator(loaded, options.commands.allow, invocation, *workers);
  };
  experiments.progress = progress_on_terminal(invocation.options());
  if (options.loop) {
    const int code = repair_loop(options, experiments, invocation);
    return report_fleet(*workers, invocation) ? code : 0;
  }
  const auto result = repair_with_experiments(repair, experiments, invocation);
  if (experiments.progress) clear_progress();
  if (!report_fleet(*workers, invocation) || !result) return 0;
  if (invocation.options().verbosity > 0) {
    for (const auto& text : result->remarks) invocation.remark(text);
  }
  invocation.options().json ? invocation.document(repair_json(*result))
                            : invocation.result(repair_text(*result, repair));
  if (result->partings.empty()) {
    const bool decided = !invocation.stopped() && result->finished && result->remarks.empty();
    return decided ? 0 : kNoneFound;
  }
  if (options.apply > 0 && !result->proposals.empty()) {
    return apply(*result, options, invocation);
  }
  if (result->proposals.empty()) return kNoneFound;
  // The proposals found are right by themselves, even if a limit kept others from being found.
  invocation.answered();
  return kProposals;
}

}  // namespace

Command repair_command() {
  auto options = std::make_shared<RepairCommandOptions>();
  OptionTable command("repair",
                      "Propose changes of a model, or a plan, that recorded runs have refuted");
  command.footer(
      "Examples:\n"
      "  parallax repair out/plan2\n"
      "  parallax repair out/plan2 --limit 1 | git apply\n"
      "  parallax repair out/plan2 --apply 1\n"
      "  parallax repair out/plan2 --runs 40 --jobs 2\n"
      "  parallax repair out/plan2 --runs 40 --hosts lab.hosts\n"
      "  parallax repair out/plan2 --loop --out repaired\n"
      "Exit codes: 0 nothing to repair, or a proposal was applied; 1 proposals; 4 none was found.");
  command.option("run_dir", options->repair.folder.folder, "The folder of a run")
      .required()
      .folder();
  add_recorded_scenario_option(command, options->repair.folder.scenario);
  command.flag("--other-model", options->repair.other_model,
               "The scenario or its model may have changed since the run");
  command.heading("Proposals");
  command.option("--limit", options->repair.limit, "Show so many proposals at most; 0: all found")
      .check(NonNegative{})
      .show_default();
  command.option("--property", options->repair.properties,
                 "Also say which of these properties of the plan each proposal breaks or restores");
  command
      .option("--apply", options->apply,
              "Write this proposal into the files of the model or the plan")
      .details(
          "Files must lie below the current folder or in its repository; else name --scenario, or "
          "give --allow-outside.")
      .check(Positive{});
  command.heading("Simulations that tell them apart");
  command
      .option("--runs", options->runs,
              "Most simulations that are made to tell proposals apart; 0: none")
      .details(fmt::format(
          "Counted with those made earlier. Default: {}, where the world is a model {}.",
          kRunsInPhysics, kRunsInModel))
      .check(WholeNumber{0, 1'000'000});
  command.option("-j,--jobs", options->experiments.jobs, "Of --runs: simulations at the same time")
      .check(WholeNumber{1, harness::kMostSlots})
      .show_default()
      .given(options->launcher.jobs_given);
  add_launcher_options(command, options->launcher);
  command.heading("Repair after repair");
  command.flag(
      "--loop", options->loop,
      "Apply the first proposal to a copy and run again, while it is the only one of its rank");
  command.option("--out", options->out, "Of --loop: a new folder for copies, runs and the log")
      .needs("--loop")
      .folder();
  command.option("--rounds", options->rounds, "Of --loop: at most so many")
      .check(WholeNumber{1, 1'000})
      .show_default()
      .needs("--loop");
  add_command_options(command, options->commands, false);
  return command_of(std::move(command), options, repair);
}

}  // namespace parallax::tools
