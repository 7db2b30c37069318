#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "harness/campaign/journal.h"
#include "tools/app/observed_path.h"
#include "tools/app/recorded_run.h"
#include "tools/repair/domain_model.h"
#include "tools/repair/evidence.h"
#include "tools/repair/start_conflict.h"
#include "tools/repair/verification.h"

namespace parallax::tools {

/// The folder in a run folder with the runs that were made to tell proposals apart.
inline constexpr const char* kExperiments = "experiments";

struct RepairOptions {
  RunFolderOptions folder;
  bool other_model = false;             // the scenario need not be as it was when it was run
  std::int64_t limit = 5;               // proposals that are shown; 0: all
  bool plan = false;                    // changes of the plan are proposed, too
  std::vector<std::string> properties;  // of the plan, checked for every proposal
};

/// A place where runs and model part.
struct RunParting {
  std::vector<std::string> ids;  // of the runs; none: the start (RepairInput::start)
  std::size_t after = 0;         // timepoint
  Evidence::Step step;           // in front of it
  Evidence::State seen;          // there, unlike what the model says
};

/// Random sequences of events, simulated.
struct RandomSequences {
  std::vector<Evidence> choosing;  // order the proposals, and ask for conditions
  std::vector<Evidence> fresh;     // others, which have no part in that: what is said rests on them
  bool of_plan = false;            // of the plan's events alone, though the model has others
};

/// Input of a repair: the scenario as it was run, its recorded runs, and where the model cannot
/// follow.
struct RepairInput {
  RepairOptions options;
  harness::JournalHeader header;
  ScenarioModel loaded;
  std::unique_ptr<DomainModel> domain;
  std::string text;                 // of the model, flat
  std::vector<ObservedPath> paths;  // of all recorded runs, in the ids of `loaded`
  /// The paths by names, those that went the same way merged, with their divergence; without those
  /// that begin where the model cannot.
  std::vector<Evidence> evidence;
  std::size_t runs = 0, failed = 0;  // recorded; those that the model cannot follow
  bool finished = true;              // the run came to a verdict of its own
  std::size_t experiments = 0;       // of them were made to tell proposals apart
  std::vector<RunParting> partings = {};
  /// Runs that went the same way up to a step and then differently: chance, or the simulator.
  std::vector<std::string> contradictions = {};
  std::vector<std::string> remarks = {};
  /// The world excludes starts of the model. This is asked of a run without a verdict in which
  /// nothing went wrong, and then is the only parting, at timepoint 0 and without runs or an event.
  std::optional<StartConflict> start = std::nullopt;
  /// Random sequences of events that the proposals are held against (validation_runs).
  RandomSequences sequences = {};
  /// The answers of `sequences.choosing` about proposals, and the effects of these on traces;
  /// shared by the inputs of one call.
  std::shared_ptr<SequenceMemo> memo = std::make_shared<SequenceMemo>();
};

/// Do both have the same events up to `t`, through the same states before the last of them?
bool goes_like(const Evidence& a, const Evidence& b, std::size_t t);

/// Sets aside the rest of runs in `taken` from a step on that the world refused in a run of
/// `failed` which went the same way up to there: what may fail is taken to fail. False: there are
/// none.
bool set_aside(const std::vector<Evidence>& failed, std::vector<Evidence>& taken);

/// Reads the runs of the folder, including those that `explain` made, and compares them with the
/// model; not all of them if `context` is stopped meanwhile. Reports what read_journal,
/// load_recorded_scenario and observed_paths report.
base::Result<RepairInput> load_repair_input(const RepairOptions& options, Context& context);

}  // namespace parallax::tools
