#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "harness/campaign/replay.h"
#include "harness/campaign/sample_runner.h"
#include "harness/cause/cause_kind.h"
#include "harness/cause/start_line.h"
#include "harness/report/standing.h"
#include "tools/app/context.h"
#include "tools/app/discrepancy.h"
#include "tools/app/evidence.h"
#include "tools/confirm/tried_starts.h"

namespace parallax::tools {

struct ConfirmOptions {
  TriedStartsOptions starts;
  std::int64_t repeats = 5;         // of the failing start, with other seeds and with half the step
  std::optional<double> tolerance;  // of borders; none: a hundredth of the parameter's range
};

/// Simulators that repeat a recorded run.
struct ConfirmSimulators {
  harness::SimulatorFactory usual;
  harness::SimulatorFactory half_step;  // null: there is none
};

/// Verdict on the discrepancy of a failing start, from its repetitions.
enum class ConfirmVerdict : std::uint8_t {
  kOpen,         // it came to no repetition
  kConfirmed,    // every repetition shows it, with other seeds and with half the step
  kPartly,       // at least half of either kind do, or none of a kind tells
  kNotRepeated,  // the same start and seed do not show it again
  kSeed,         // with most other seeds it does not happen
  kStep,         // with half the step it does not, in most runs
};
/// "open", "confirmed", "partly", "not-repeated", "seed", "step"
std::string_view to_string(ConfirmVerdict verdict);

/// A repeated discrepancy, and its simplified start.
struct Confirmation {
  harness::SampleId sample;
  std::uint64_t seed = 0;       // of that simulation
  std::string digest, words;    // likewise; what went wrong in it
  std::string determinism;      // the simulator's own statement
  bool repeats_itself = false;  // the simulator promises that, and takes seeds
  std::int64_t repeats = 0;     // requested repetitions of either kind
  bool world_is_model = false, has_seeds = true, has_half_step = true;
  /// Result of the same start and seed once more; none: not simulated.
  std::optional<harness::StartVerdict> repeated;
  std::optional<harness::RecordDifference> difference;  // none: equal to the last bit
  std::optional<harness::Persistence> other_seeds, half_step;
  std::vector<StartParameter> parameters;
  std::vector<std::string> fixed;  // parameters without a width
  bool has_law = false;            // of starts
  StartPlace place;
  std::optional<harness::ShrunkStart> shrunk;
  TriedStarts::End end = TriedStarts::End::kNot;
  std::int64_t runs = 0, budget = 0;  // simulations that it took, on record so far
  ConfirmVerdict verdict() const;
  /// The results of moved starts are not a matter of chance, as far as the repetitions tell.
  bool may_move() const;
  /// Everything that was asked for was simulated.
  bool finished() const {
    return end == TriedStarts::End::kNot && verdict() != ConfirmVerdict::kOpen;
  }
};

/// Repeats the discrepancy, then moves its start towards the middle of its cell. `found` has a
/// parting. Reports as TriedStarts and same_start_runs do. The findings are kept in RUN_DIR/confirm
/// for `report`.
base::Result<Confirmation> confirm_discrepancy(const std::string& run_dir,
                                               const RecordedDiscrepancy& found,
                                               const ScenarioModel& as_run,
                                               const ConfirmSimulators& simulators,
                                               const ConfirmOptions& options, Context& context);

struct ThresholdOptions {
  TriedStartsOptions starts;
  std::string parameter;
  std::int64_t points = 5;
  std::optional<double> tolerance;
};

/// The borders of a discrepancy along one parameter of its start.
struct Threshold {
  harness::SampleId sample;
  std::uint64_t seed = 0;
  std::string digest, words;
  bool repeats = false;  // the simulator is deterministic and takes seeds
  bool has_law = false;  // of starts
  StartPlace place;
  StartParameter parameter;
  double tolerance = 0.0;
  /// The failing start once more; kFails, or there is no scan.
  std::optional<harness::StartVerdict> repeated;
  harness::LineScan scan;
  TriedStarts::End end = TriedStarts::End::kNot;
  std::int64_t runs = 0, budget = 0;
  /// Every bracket is as narrow as was asked for.
  bool finished() const;
};

/// Reports kUsage for a parameter that starts do not have, or have only one value of.
base::Result<Threshold> find_threshold(const std::string& run_dir, const RecordedDiscrepancy& found,
                                       const ScenarioModel& as_run,
                                       const harness::SimulatorFactory& simulator,
                                       const ThresholdOptions& options, Context& context);

/// As the commands print them, for people and as one JSON object.
std::string confirm_text(const Confirmation& confirmation, const std::string& run_dir);
std::string confirm_json(const Confirmation& confirmation);
std::string threshold_text(const Threshold& threshold, const std::string& run_dir);
std::string threshold_json(const Threshold& threshold);
/// The standing of the discrepancy in a headline, by the repetitions.
harness::DiscrepancyStanding standing_of(const Confirmation& confirmation);
/// The findings, a sentence each.
std::vector<std::string> confirm_sentences(const Confirmation& confirmation);
std::vector<std::string> threshold_sentences(const Threshold& threshold);

/// "after `Go(r2)` at 0 `BoxIn(r1)` does not hold": where a discrepancy's simulation and the model
/// part.
std::string parting_words(const RecordedDiscrepancy& found);

/// Findings of `confirm` and `threshold` about one simulation, as sentences, read from its run
/// folder.
struct KeptFindings {
  harness::DiscrepancyStanding standing;  // by `confirm`
  std::vector<std::string> confirmed;
  std::vector<std::string> thresholds;
};
/// Reads the findings about this simulation of the run; empty where nothing is on record. A damaged
/// file counts as one without findings.
KeptFindings kept_findings(const std::string& run_dir, const harness::SampleRecord& record);
/// Writes the finding, in the place of the earlier one about the same simulation (and parameter).
base::Status keep_finding(const std::string& run_dir, const Confirmation& confirmation,
                          base::DiagnosticSink& sink);
base::Status keep_finding(const std::string& run_dir, const Threshold& threshold,
                          base::DiagnosticSink& sink);

}  // namespace parallax::tools
