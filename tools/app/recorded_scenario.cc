#include "tools/app/recorded_scenario.h"

#include <fmt/format.h>

#include <system_error>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/diagnostic_printer.h"
#include "harness/campaign/replay.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using base::DiagnosticCode;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

}  // namespace

fs::path scenario_path(const harness::JournalHeader& header) {
  const fs::path named(header.scenario);
  if (header.start_folder.empty() || named.is_absolute()) return named;
  std::error_code error;
  const fs::path start(header.start_folder);
  // Where the run was started it is called as it was then.
  if (fs::equivalent(start, fs::current_path(error), error)) return named;
  return is_file(start / named) || !is_file(named) ? start / named : named;
}

base::Result<ScenarioModel> load_recorded_scenario(const RunFolderOptions& options,
                                                   const harness::JournalHeader& header,
                                                   ScenarioUse use, Context& context) {
  auto& sink = context.sink();
  const bool is_recorded = options.scenario.empty();
  const auto path = is_recorded ? scenario_path(header) : fs::path(options.scenario);
  const auto refuse = [&](const std::string& why) {
    return sink.error_about(DiagnosticCode::kReplayImpossible, options.folder, why);
  };
  if (is_recorded && !is_file(path)) {
    return refuse(fmt::format("there is no scenario `{}`", base::printable(path.string())));
  }
  const auto before = sink;
  auto loaded = use == ScenarioUse::kRun ? load_scenario_model(path, context)
                                         : load_plain_scenario(path, context);
  const auto change =
      loaded ? harness::scenario_change(header, loaded->sources_hash) : std::string();
  if (loaded && change.empty()) return loaded;
  if (is_recorded) sink = before;
  if (!loaded && !is_recorded) return sink.already_reported();
  if (loaded) return refuse(change);
  const auto name = base::printable(path.string());
  return refuse(fmt::format(
      "the scenario `{}` cannot be loaded any more; `parallax check {}` says why", name, name));
}

}  // namespace parallax::tools
