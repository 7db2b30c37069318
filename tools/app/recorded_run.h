#pragma once

#include "compiler/base/result.h"
#include "harness/campaign/replay.h"
#include "harness/config/scenario.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// A run folder as the command line names it.
struct RunFolderOptions {
  std::string folder;
  std::string scenario;  // if the file was moved; empty: where the journal says
  /// Use the texts that the run kept (kInputsName) if the project's files have changed since. False
  /// for commands that edit the project's files.
  bool may_use_kept = true;
};

/// The options to load the scenario once more, by the name under which it was found.
RunFolderOptions found_again(const std::string& folder, const ScenarioModel& loaded);

/// Where the scenario of a run lies: a relative path starts in the folder that the run was started
/// in, or in the current folder if nothing lies there.
std::filesystem::path scenario_path(const harness::JournalHeader& header);

/// The comparison and execution mode of the run, whatever the scenario says by itself. The first is
/// none where the journal does not say.
std::optional<harness::Comparison> recorded_comparison(const harness::JournalHeader& header);
harness::Execution recorded_execution(const harness::JournalHeader& header);

/// How a scenario is compiled: as it was run, or as it was run and to be explained
/// (ScenarioNeeds::plain).
enum class ScenarioUse : std::uint8_t { kRun, kExplain };

/// Loads the scenario of a run, which must be the one that was run. Where it has changed or cannot
/// be read any more, the texts that the run kept are loaded, and a remark says so: their names are
/// those of then. kReplayImpossible if there are none. A journal may name any file, so of one that
/// is not the scenario of the run nothing is said but this, unless the user named it. Where it is
/// not found by the name that it has from here, a remark says which file it is.
base::Result<ScenarioModel> load_recorded_scenario(const RunFolderOptions& options,
                                                   const harness::JournalHeader& header,
                                                   ScenarioUse use, Context& context);

/// Reports kReplayImpossible for a run of random sequences of events (`learn --explore`): they are
/// no traces of the model, so that nothing but to repeat them makes sense.
base::Status expect_traces(const RunFolderOptions& options, const harness::JournalHeader& header,
                           base::DiagnosticSink& sink);

/// Can the scenario have had this simulation? Its trace must be one of the model, its calls those
/// of the actions, its start and seed what is drawn for its number; an executed plan must have gone
/// as it is on record after what was seen and reported (ExecutionCheck). What was observed is
/// believed. Gives the trace in the ids of the model. Reports
/// kForeignJournalLine.
base::Result<harness::CampaignTrace> check_recorded_run(const ScenarioModel& loaded,
                                                        const harness::RecordedRun& run,
                                                        Context& context);

/// Is the start and seed of each simulation of a trace what is drawn for its number? The journal
/// has a header. Reports kForeignJournalLine.
base::Status check_recorded_starts(const ScenarioModel& loaded, const harness::JournalText& journal,
                                   Context& context);

}  // namespace parallax::tools
