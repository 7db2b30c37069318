#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "harness/campaign/journal.h"
#include "harness/campaign/replay.h"

namespace parallax::harness {

/// One recorded simulation with what was asked of the simulator.
struct RecordedRun {
  JournalHeader header;  // of the journal
  SampleId id;
  SampleRecord record;
  std::vector<ActionCall> calls;    // per event
  std::vector<std::string> events;  // as the trace has them
};

/// The first discrepancy of a run (a repetition in the journal marks it), else its first sample.
std::optional<SampleId> default_sample(const JournalText& journal);

/// Reads it from the journal of a run folder. Without `id`: the first discrepancy, else the first
/// sample. Reports what replay_sample reports.
base::Result<RecordedRun> read_recorded_run(const std::filesystem::path& run_dir,
                                            std::optional<SampleId> id, base::SourceFiles& files,
                                            base::DiagnosticSink& sink);

/// Why scenario files of this hash are not those of the run; empty: they are. To be asked before a
/// simulator is made: what a changed scenario names as its simulator must not be started.
std::string scenario_change(const JournalHeader& header, const std::string& scenario_hash);

/// Why `simulator` is not the one of the run, or did not start; empty: it is.
std::string simulator_change(const JournalHeader& header, const SimulatorInfo& simulator);

}  // namespace parallax::harness
