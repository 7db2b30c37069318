#include <unistd.h>

#include <memory>

#include "compiler/base/diagnostic_codes.h"
#include "harness/campaign/replay.h"
#include "harness/report/report.h"
#include "tools/app/file_kind.h"
#include "tools/app/recorded_run.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct ReplayOptions {
  RunFolderOptions run;
  std::string sample;
  CommandPermission commands;
};

int replay(const ReplayOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto id = parse_sample_option(options.sample, sink);
  if (!id) return 0;
  if (!expect_kind(options.run.folder, {FileKind::kRun}, "the folder of a run", invocation)) {
    return 0;
  }
  const auto run = harness::read_recorded_run(options.run.folder, *id, invocation.files(), sink);
  if (!run) return 0;
  const auto loaded =
      load_recorded_scenario(options.run, run->header, ScenarioUse::kRun, invocation);
  if (!loaded || !check_recorded_run(*loaded, *run, invocation)) return 0;
  const auto simulator = permitted_simulator(*loaded, options.commands.allow, invocation);
  if (!simulator) return 0;
  const auto result = harness::replay_sample(*run, loaded->sources_hash, *simulator);
  if (result.outcome == harness::ReplayOutcome::kCannot) {
    sink.error_about(base::DiagnosticCode::kReplayImpossible, options.run.folder, result.reason);
    return 0;
  }
  if (invocation.options().json) {
    invocation.document(harness::replay_json(result));
  } else {
    invocation.result(harness::replay_text(result, {invocation.color_on(STDOUT_FILENO)}));
  }
  return result.outcome == harness::ReplayOutcome::kIdentical ? 0 : 1;
}

}  // namespace

Command replay_command() {
  auto options = std::make_shared<ReplayOptions>();
  OptionTable command("replay", "Repeat one recorded simulation and compare it bit by bit");
  command.footer(
      "Examples:\n"
      "  parallax replay out/edge                the run's first discrepancy\n"
      "  parallax replay out/edge --sample 1.4   simulation 4 of trace 1\n"
      "Exit codes: 0 identical, 1 differs, 3 the scenario has changed since.");
  command.option("run_dir", options->run.folder, "Folder of a run").required();
  command.option("--sample", options->sample, "TRACE.SAMPLE; default: the first discrepancy");
  add_recorded_scenario_option(command, options->run.scenario);
  add_command_options(command, options->commands, false);
  return {std::move(command),
          [options](Invocation& invocation) { return replay(*options, invocation); }};
}

}  // namespace parallax::tools
