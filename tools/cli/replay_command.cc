#include <unistd.h>

#include <memory>

#include "compiler/base/diagnostic_codes.h"
#include "harness/campaign/replay.h"
#include "harness/report/report.h"
#include "tools/app/scenario_model.h"
#include "tools/app/simulator_factory.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"
#include "tools/cli/signals.h"

namespace parallax::tools {
namespace {

struct ReplayOptions {
  std::string run_dir;
  std::string sample;
};

int replay(const ReplayOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto id = parse_sample_option(options.sample, sink);
  if (!id) return 0;
  // The journal is no source of the scenario: it is read into a set of its own.
  base::SourceFiles journal_files;
  base::DiagnosticSink journal_sink;
  const auto header = harness::read_run_header(options.run_dir, journal_files, journal_sink);
  std::optional<ScenarioModel> loaded;
  if (header) {
    auto result = load_scenario_model(header->scenario, invocation);
    if (!result) return 0;
    loaded = *std::move(result);
  }
  // Without a header the same call reports what is wrong with the journal.
  if (!loaded) {
    (void)harness::read_run_header(options.run_dir, invocation.files(), sink);
    return 0;
  }
  const auto result = harness::replay_sample(options.run_dir, *id, loaded->sources_hash,
                                             simulator_factory(*loaded, own_worker(), stop_flag()),
                                             invocation.files(), sink);
  if (!result) return 0;
  if (result->outcome == harness::ReplayOutcome::kCannot) {
    sink.error_about(base::DiagnosticCode::kReplayImpossible, options.run_dir, result->reason);
    return 0;
  }
  if (invocation.options().json) {
    invocation.document(harness::replay_json(*result));
  } else {
    invocation.result(harness::replay_text(*result, {invocation.color_on(STDOUT_FILENO)}));
  }
  return result->outcome == harness::ReplayOutcome::kIdentical ? 0 : 1;
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
  command.option("run_dir", options->run_dir, "Folder of a run").required();
  command.option("--sample", options->sample, "TRACE.SAMPLE; default: the first discrepancy");
  return {std::move(command),
          [options](Invocation& invocation) { return replay(*options, invocation); }};
}

}  // namespace parallax::tools
