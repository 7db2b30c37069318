#include <unistd.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "harness/campaign/replay.h"
#include "harness/recording/recording_file.h"
#include "harness/report/report.h"
#include "tools/app/file_kind.h"
#include "tools/app/own_identity.h"
#include "tools/app/recorded_run.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct ReplayOptions {
  RunFolderOptions run;
  std::string sample;
  bool record = false;
  CommandPermission commands;
};

/// Keeps the recording, even of a repetition that differs: it shows what the simulator does now.
base::Status keep(const std::string& folder, const std::optional<harness::Recording>& moved,
                  Invocation& invocation) {
  auto& sink = invocation.sink();
  if (!moved) {
    return sink.error_about(codes::kReplayImpossible, folder,
                            "its simulator tells nothing of motion, so there is nothing to record");
  }
  const auto name = harness::recording_name(moved->trace, moved->sample);
  if (auto why = harness::write_recording(folder, *moved); !why.empty()) {
    return sink.error_about(codes::kFileNotWritable,
                            (std::filesystem::path(folder) / name).string(), why);
  }
  if (!moved->missing.empty()) {
    sink.error_about(codes::kRecordingLost, folder, 1, moved->missing);
  }
  invocation.remark("recording: " + (std::filesystem::path(folder) / name).string());
  return base::Unit{};
}

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
  std::optional<harness::Recording> moved;
  auto result = harness::replay_sample(*run, loaded->sources_hash, *simulator,
                                       options.record ? &moved : nullptr);
  if (result.outcome == harness::ReplayOutcome::kDiffers) {
    const auto self = own_identity(loaded->scenario);
    result.machine = harness::machine_change(run->header, run->record, self.arithmetic, self.build);
  }
  if (result.outcome == harness::ReplayOutcome::kCannot) {
    sink.error_about(codes::kReplayImpossible, options.run.folder, result.reason);
    return 0;
  }
  if (options.record && !keep(options.run.folder, moved, invocation)) return 0;
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
      "  parallax replay out/edge --sample 1.4 --record\n"
      "Exit codes: 0 identical, 1 differs, 3 the scenario has changed since.");
  command.option("run_dir", options->run.folder, "Folder of a run").required().folder();
  command.option("--sample", options->sample, "TRACE.SAMPLE; default: the first discrepancy");
  command.flag("--record", options->record,
               "Write what moves into the run folder, for `report` and `export`");
  add_recorded_scenario_option(command, options->run.scenario);
  add_command_options(command, options->commands, false);
  return command_of(std::move(command), options, replay);
}

}  // namespace parallax::tools
