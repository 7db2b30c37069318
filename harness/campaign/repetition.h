#pragma once

// Does a run affect those after it? What is claimed of runs supposes that none does, which no
// number of clean runs shows: a simulator may wear out, leak, or learn. So the first clean
// simulation is made twice more when the others are over, with the same start and seed: by a worker
// that made others before, and by a simulator that was started for it. Neither is a sample, and
// nothing is counted. Cost: two simulations and one start of the simulator.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/campaign_result.h"
#include "harness/campaign/sample_maker.h"
#include "harness/campaign/sample_record.h"

namespace parallax::harness {

class SimulatorBench;

/// A clean simulation, and how it is made and judged again.
struct CleanSample {
  SampleRecord record;
  std::shared_ptr<const SampleMaker> maker;
  /// Whether a simulation of this start went as the model admits. None: stopped on the way.
  std::function<std::optional<bool>(const SampleRecord&)> is_clean;
};

/// Makes both repetitions. Without those that were stopped. Closes the bench's workers.
RepetitionResult repeat_clean(const CleanSample& sample, SimulatorBench& bench);

/// Doubts that the repetitions cast on the claims of a run, one sentence each. Different bits count
/// only if the simulator promised bitwise repetition.
std::vector<std::string> repetition_doubts(const RepetitionResult& result,
                                           const SimulatorInfo& simulator);

/// Takes back what a run claimed, where a repetition was not clean: claims, bounds and the verdict
/// of traces without discrepancy. Adds the doubts to the caveats.
void apply_repetition(CampaignResult& result);

}  // namespace parallax::harness
