#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "harness/campaign/campaign_result.h"
#include "tools/repair/experiments.h"

namespace parallax::tools {

struct RepairLoopOptions {
  RepairOptions repair;
  ExperimentOptions experiments;
  std::string out;          // a new folder: copies of the scenario's files, runs, the log
  std::int64_t rounds = 8;  // at most
};

/// Why it ended.
enum class LoopEnd : std::uint8_t {
  kClean,         // a run without discrepancy
  kNothing,       // the model admits all runs of the folder
  kTie,           // the first proposal is not the only one of its rank
  kNone,          // no proposal
  kPlanAtFault,   // with what was repaired no trace, or none from some starts that had one, reaches
                  // the constraints
  kRefuted,       // a run without discrepancy, but random sequences of events refute the change
  kInconclusive,  // the run decided nothing
  kRounds,        // the limit of rounds was reached
  kStopped,
  kFailed,  // with an error, which was reported
};
/// "clean", "nothing-to-repair", "tie", "no-proposal", "plan-at-fault", ...
std::string_view to_string(LoopEnd end);

struct RepairRound {
  std::string folder;  // of the runs that were repaired
  std::size_t runs = 0, failed = 0, experiments = 0;
  std::string words, patch;             // of what was applied; empty: nothing was
  std::optional<TraceEffects> effects;  // of that
  std::string next_folder;              // of the run after it
  std::string verdict;
  std::vector<std::string> claims;  // by trace
};

struct RepairLoop {
  std::vector<RepairRound> rounds;
  LoopEnd end = LoopEnd::kStopped;
  std::string why;                 // a sentence without its period
  std::vector<ChangedFile> files;  // the user's, as they were and as the loop left its copies
  std::vector<std::string> read_by_world;  // of these
};

/// Repairs, runs again and repairs the next discrepancy, in copies of the scenario's files; a world
/// that is a model stays as it is. Each repair also has to hold for the runs of all earlier rounds.
/// Each run has the settings of the recorded one, except its seed. Reports what repairing and
/// running report, and an `out` that is not a new folder; rounds before an error are written, and
/// returned.
base::Result<RepairLoop> repair_in_rounds(const RepairLoopOptions& options, Context& context);

std::string loop_text(const RepairLoop& loop);
std::string loop_json(const RepairLoop& loop);

}  // namespace parallax::tools
