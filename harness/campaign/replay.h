#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "compiler/base/diagnostic.h"
#include "harness/campaign/campaign.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/sample_record.h"
#include "harness/recording/recording.h"

namespace parallax::harness {

enum class ReplayOutcome : std::uint8_t {
  kIdentical,
  kDiffers,
  kCannot,  // the scenario, or the simulator, is not the one that was recorded
};

/// "2.4": sample 4 of trace 2.
struct SampleId {
  std::int64_t trace = 0;
  std::int64_t sample = 0;
};
std::optional<SampleId> parse_sample_id(std::string_view text);

/// The first value that differs; each as shortest decimal and, for numbers, in hexadecimal.
struct ReplayDifference {
  std::int64_t timepoint = 0;
  std::string variable;  // "box.x", "digest", or "act: status"
  std::string recorded;
  std::string repeated;
};

struct ReplayResult {
  ReplayOutcome outcome = ReplayOutcome::kIdentical;
  SampleId id;
  std::uint64_t seed = 0;
  std::string reason;  // for kCannot
  std::optional<ReplayDifference> difference;
  std::size_t timepoints = 0;  // compared
  std::string digest;          // recorded
  MachineChange machine;       // since it was recorded
};

/// One recorded simulation with what was asked of the simulator.
struct RecordedRun {
  JournalHeader header;  // of the journal
  SampleId id;
  SampleRecord record;
  TraceLine line;                          // its trace and the calls for that
  base::SourceRange source, trace_source;  // their lines in the journal
};
/// One that is there.
RecordedRun recorded_run(const JournalText& journal, SampleId id);

/// The first discrepancy of a run (a repetition in the journal marks it), else its first sample.
std::optional<SampleId> default_sample(const JournalText& journal);

/// Reads it from the journal of a run folder. Without `id`: the first discrepancy, else the first
/// sample. Reports what read_journal reports, kNoJournal where no header was written, and
/// kNoSuchSample with what is there.
base::Result<RecordedRun> read_recorded_run(const std::filesystem::path& run_dir,
                                            std::optional<SampleId> id, base::SourceFiles& files,
                                            base::DiagnosticSink& sink);

/// Why scenario files of this hash are not those of the run; empty: they are. To be asked before a
/// simulator is made: what a changed scenario names as its simulator must not be started.
std::string scenario_change(const JournalHeader& header, const std::string& scenario_hash);

/// The reason why `simulator` is not the one of the run, or did not start; empty: it is.
std::string simulator_change(const JournalHeader& header, const SimulatorInfo& simulator);

/// Repeats one recorded simulation and compares every observation, every outcome and the digest
/// bit for bit. A simulator is made only if nothing that is on record forbids the repetition, above
/// all a changed scenario.
/// `moved`: the repetition is recorded there, where it came to its end, whether it differs or not.
/// The caller asks whether the machine has changed (machine_change).
ReplayResult replay_sample(const RecordedRun& run, const std::string& scenario_hash,
                           const SimulatorFactory& make_simulator,
                           std::optional<Recording>* moved = nullptr);

}  // namespace parallax::harness
