#pragma once

#include <filesystem>
#include <string>

#include "harness/campaign/journal_format.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// A run folder as the command line names it.
struct RunFolderOptions {
  std::string folder;
  std::string scenario;  // where it lies by now; empty: where the journal says
};

/// Where the scenario of a run lies: a relative path starts in the folder that the run was started
/// in, or in the current folder if nothing lies there.
std::filesystem::path scenario_path(const harness::JournalHeader& header);

/// How a scenario is compiled: to be run, or to be explained (load_plain_scenario).
enum class ScenarioUse : std::uint8_t { kRun, kExplain };

/// Loads the scenario of a run, which must be the one that was run: kReplayImpossible if it is not,
/// or cannot be read any more. A journal may name any file, so of one that is not the scenario of
/// the run nothing is said but this, unless the user named it.
base::Result<ScenarioModel> load_recorded_scenario(const RunFolderOptions& options,
                                                   const harness::JournalHeader& header,
                                                   ScenarioUse use, Context& context);

}  // namespace parallax::tools
