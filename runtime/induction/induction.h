#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string_view>

#include "compiler/base/result.h"
#include "runtime/certify/certificate.h"

namespace parallax::runtime {

/// A property of all timepoints, in terms of models with an atom kHit where it is broken.
struct InductionTask {
  /// From the start up to its horizon, over which induction can begin; it outlives the task.
  const CompiledModel* whole = nullptr;
  /// Every stretch of that many steps that a trace can have after `last_fixed`.
  std::function<base::Result<CompiledModel>(Timepoint steps)> window;
  Timepoint last_fixed = -1;      // the last timepoint that is not like any other
  Timepoint width = 1;            // how many timepoints the model's clauses span, less one
  Timepoint back = 0, ahead = 0;  // how far before and behind its timepoint the property looks
  const std::atomic<bool>* stop = nullptr;
};

enum class InductionVerdict : std::uint8_t {
  kHolds,      // at every timepoint of every trace of any horizon
  kBroken,     // a trace that ends within the horizon breaks it, first at `broken_at`
  kUndecided,  // `steps` are not enough, and the horizon admits no more
  kNotProved,  // a proof was not accepted, or an error ended the work: reported
  kStopped,
};

struct InductionAnswer {
  InductionVerdict verdict = InductionVerdict::kStopped;
  Timepoint steps = 0;         // timepoints that the step assumes the property of
  std::size_t invariants = 0;  // that were found and proved on the way
  std::optional<Timepoint> broken_at;
};

/// Has a claim's contradiction proved and checked; `name` tells the claims of a task apart.
using ClaimProver = std::function<ProofVerdict(const ProofClaim& claim, std::string_view name)>;

/// k-induction for k = 1, 2, 4, ... up to what the horizon admits (induction.cc). Holds only if all
/// claims that make it up were proved and their proofs accepted.
InductionAnswer decide_by_induction(const InductionTask& task, const ClaimProver& prove);

}  // namespace parallax::runtime
