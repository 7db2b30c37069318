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

/// What keeps a repetition of the run by `simulator`, with scenario files of this hash, from
/// meaning anything; empty: nothing.
std::string obstacle_to_repeat(const JournalHeader& header, const std::string& scenario_hash,
                               const SimulatorInfo& simulator);

}  // namespace parallax::harness
