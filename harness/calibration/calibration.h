#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "harness/calibration/synthetic_simulator.h"
#include "harness/confidence/criterion_spec.h"
#include "harness/confidence/spending.h"

namespace parallax::harness {

class ConfidenceCriterion;

/// A criterion that is measured, and what it says of itself.
struct CalibratedCriterion {
  std::string name;  // "paper-literal"
  CriterionSpec spec;
  bool is_judged = true;  // it claims to err as rarely as its level says; the paper's rule does not
  /// None: make_criterion.
  std::function<std::unique_ptr<ConfidenceCriterion>(const CriterionSpec&)> make = {};
};

/// A simulator, and how its traces are claimed where there are two.
struct CalibratedWorld {
  SyntheticKind kind = SyntheticKind::kByStart;
  std::optional<Family> family;  // of two traces; none: there is one
  bool is_counted = true;        // where one of two is left out: their number is known
  std::string name;
};

/// Loops of one criterion in one world.
struct CalibrationCell {
  std::string world, criterion;
  std::int64_t loops = 0;
  std::int64_t false_claims = 0;  // loops in which something false was claimed
  double mean_runs = 0.0;
  /// The allowed share of loops, by what is claimed; none: nothing says so.
  std::optional<double> allowed;

  double share() const {
    return loops == 0 ? 0.0 : static_cast<double>(false_claims) / static_cast<double>(loops);
  }
  /// Not above what is allowed by more than four standard errors: a chance below 1e-4 a cell for a
  /// criterion that errs exactly as often as it may.
  bool is_within() const;
};

struct CalibrationOptions {
  double confidence_level = 0.99, epsilon = 0.05;
  std::uint64_t seed = 1;
  std::int64_t loops = 4000, protocol_loops = 400;  // in process; through the protocol
  std::vector<std::string> command;  // starts a SyntheticSimulator (synthetic_arguments follow)
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const CalibrationCell&)> progress;
};

/// The criteria at a level, and the worlds, in the order of the table.
std::vector<CalibratedCriterion> calibrated_criteria(double confidence_level, double epsilon);
std::vector<CalibratedWorld> calibrated_worlds();

/// The probability of a run of this trace, from 1, to go wrong: epsilon itself, so that every claim
/// is false. Where the first of two traces is left out it is the bound that the second one's share
/// of the error supports after the planned clean runs, as that is claimed then.
double calibrated_probability(const CalibratedCriterion& criterion, const CalibratedWorld& world,
                              int trace);

/// The end of one trace of a loop.
struct CalibratedTrace {
  bool is_discrepancy = false;
  bool passed = false;            // the criterion was met
  CertifiedBound stated, shared;  // as FamilyMember has them
  double probability = 0.0;       // of a run to go wrong
};

/// Is what is claimed of these traces false? One trace, and each one of `per-trace`, is claimed
/// where it passed; several are claimed together, as family_claim does.
bool is_false_claim(const CalibratedCriterion& criterion, const CalibratedWorld& world,
                    const std::vector<CalibratedTrace>& traces);

/// Is the criterion measured in that world? That of the paper is about one initial state.
bool is_measured(const CalibratedCriterion& criterion, const CalibratedWorld& world);

/// The share of loops in which a false claim is allowed, by the wording of the claim: 1-C, or twice
/// that if `clean-runs` may have to say so after a loss, and if each of two traces is claimed by
/// itself. None: the criterion is not judged.
std::optional<double> allowed_share(const CalibratedCriterion& criterion,
                                    const CalibratedWorld& world);

/// One cell by loops in this process: the law of the campaign, without campaign and simulator.
CalibrationCell in_process_cell(const CalibratedCriterion& criterion, const CalibratedWorld& world,
                                const CalibrationOptions& options, std::int64_t loops);

/// One cell by whole campaigns, each with a simulator in a child process that speaks the protocol.
/// Reports what keeps a campaign from its result.
base::Result<CalibrationCell> protocol_cell(const CalibratedCriterion& criterion,
                                            const CalibratedWorld& world,
                                            const CalibrationOptions& options, std::int64_t loops,
                                            base::DiagnosticSink& sink);
/// Can a campaign be in that state? A number of traces that is not known takes more than two.
bool has_campaign(const CalibratedWorld& world);

/// The arguments that follow `CalibrationOptions::command`.
std::vector<std::string> synthetic_arguments(const SyntheticSimulator::Options& options);

struct CalibrationResult {
  CalibrationOptions options;
  std::vector<CalibrationCell> in_process, protocol;  // by world, then by criterion
  bool complete = true;                               // false: stopped
  bool is_within() const;                             // every cell that is judged
};
base::Result<CalibrationResult> calibrate(const CalibrationOptions& options,
                                          const std::vector<CalibratedCriterion>& criteria,
                                          const std::vector<CalibratedWorld>& worlds,
                                          base::DiagnosticSink& sink);

/// Two tables in Markdown, one JSON document.
std::string calibration_markdown(const CalibrationResult& result);
std::string calibration_json(const CalibrationResult& result);

}  // namespace parallax::harness
