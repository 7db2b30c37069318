#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "harness/campaign/campaign.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/sample_runner.h"
#include "harness/cause/cause_kind.h"
#include "tools/app/context.h"
#include "tools/app/discrepancy.h"

namespace parallax::tools {

/// Evidence for the kind of cause, from all recorded simulations of a trace.
struct CauseEvidence {
  harness::CauseFinding finding;
  std::vector<std::string> parameters;  // of the start, those that differ from run to run
  std::int64_t otherwise = 0;  // runs that went wrong earlier or otherwise, and say nothing of this
  std::int64_t further = 0;    // runs that were made for it, now or earlier
  /// Why no further ones were made; empty: as many as were asked for.
  std::string not_made;

  /// The initial states that it fails in; empty where the runs do not tell.
  std::string where() const {
    return finding.where ? harness::state_words(*finding.where) : std::string();
  }
  std::string words() const { return harness::cause_words(finding, parameters); }
};

/// Simulations that were made beside a run, with the trace from those of its initial states that
/// the run did not begin in.
struct FurtherRecords {
  std::vector<harness::SampleRecord> samples;
  std::map<harness::StartKey, harness::TraceLine> starts;
};

/// Finds out from the starts of one trace's simulations why some of them failed.
CauseEvidence cause_of(const std::vector<const harness::State*>& starts,
                       const std::vector<bool>& failed, bool world_is_model,
                       const std::vector<harness::CauseBorder>& borders = {});

/// Those of the journal (and `further`, of the same trace) that get as far as the discrepancy: does
/// it happen there again? What `confirm` has found in `run_dir` is taken into account. Reports as
/// observed_paths does.
base::Result<CauseEvidence> gather_evidence(const std::string& run_dir,
                                            const RecordedDiscrepancy& found,
                                            const FurtherRecords& further, Context& context);

/// Number of these simulations, of the same trace or of executions, that go wrong like the
/// discrepancy; they are numbered from 1, whatever the numbers in the journal. Simulations that
/// tell nothing are left out.
base::Result<harness::Persistence> count_failures(const RecordedDiscrepancy& found,
                                                  const std::vector<harness::SampleRecord>& records,
                                                  Context& context);

/// Those of the simulations, seen to their end, that begin as the discrepancy did.
std::vector<harness::SampleRecord> of_same_start(const RecordedDiscrepancy& found,
                                                 const std::vector<harness::SampleRecord>& records);

struct FurtherRunsOptions {
  std::int64_t runs = 60;    // limit, counted with those made earlier
  std::int64_t enough = 10;  // enough failures, with as many clean runs or none at all
  std::int64_t jobs = 1;
  std::function<void(const harness::CampaignProgress&)> progress;
  std::int64_t repeats = 5;    // of the failing start, of either kind (same_start_runs)
  bool without_seeds = false;  // also where the simulator takes no seeds and is not deterministic
};

/// Are this many failed and clean runs enough evidence?
inline bool is_enough(const FurtherRunsOptions& options, std::int64_t failures,
                      std::int64_t clean) {
  return failures >= options.enough && (clean == 0 || clean >= options.enough);
}

/// The folder in a run folder that has them.
inline constexpr const char* kFurtherRuns = "further";

/// Simulates the discrepancy's trace from further starts, those that the run would have drawn next,
/// and records them in RUN_DIR/further, where they are found the next time; the run itself stays as
/// it is, also for --resume. `as_run`: the scenario as it is run. Of a trace only; reports as
/// estimate_rates does, and what claiming a folder reports.
base::Result<FurtherRecords> further_runs(const std::string& run_dir,
                                          const RecordedDiscrepancy& found,
                                          const ScenarioModel& as_run,
                                          const harness::SimulatorFactory& make_simulator,
                                          const FurtherRunsOptions& options, Context& context);

/// The same of an executed plan: executions that begin in the state that the discrepancy began in.
base::Result<FurtherRecords> further_executions(const std::string& run_dir,
                                                const RecordedDiscrepancy& found,
                                                const ScenarioModel& as_run,
                                                const harness::SimulatorFactory& make_simulator,
                                                const FurtherRunsOptions& options,
                                                Context& context);

/// Simulates the discrepancy's own start and actions again, `repeats` times each with other seeds
/// and with the simulator of half the step (null: there is none), and records that in
/// RUN_DIR/same_start and RUN_DIR/half_step. Of an executed plan the actions up to where it went
/// wrong. Reports as further_runs does.
/// A folder keeps those of several discrepancies apart by their starts.
inline constexpr const char* kOtherSeeds = "same_start";
inline constexpr const char* kHalfStep = "half_step";
struct SameStart {
  std::optional<harness::Persistence> other_seeds, half_step;
  bool has_seeds = true;  // the simulator takes them
};
base::Result<SameStart> same_start_runs(const std::string& run_dir,
                                        const RecordedDiscrepancy& found,
                                        const ScenarioModel& as_run,
                                        const harness::SimulatorFactory& make_simulator,
                                        const harness::SimulatorFactory& half_step,
                                        const FurtherRunsOptions& options, Context& context);

}  // namespace parallax::tools
