#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "compiler/base/diagnostic.h"
#include "runtime/certify/completeness_claim.h"
#include "runtime/certify/proof_files.h"
#include "runtime/proof/check_proof.h"

namespace parallax::runtime {

enum class ProofOrigin : std::uint8_t {
  kSearch,      // the log of the solver that found the traces
  kFreshSolve,  // a solver that starts afresh refuted the claim
};

struct Certificate {
  ProofVerdict verdict = ProofVerdict::kNotFinished;
  ProofStatistics statistics;
  std::int64_t proof_bytes = 0;
  ProofOrigin origin = ProofOrigin::kFreshSolve;
};

/// Writes the claim and a proof of it, and has both checked as they are on the disk. If the search
/// was `logged` in the proof file, this log is tried first; if it is not accepted, or there is
/// none, a solver that starts afresh makes the proof. The files are kept if a proof is accepted.
/// Reports kFileNotWritable; kProofRejected, also where the solver finds a further trace;
/// kProofNotChecked if solver or checker were stopped.
Certificate prove(const CompletenessClaim& claim, ProofFiles& files, const ProofLimits& limits,
                  base::DiagnosticSink& sink, bool logged = false);

}  // namespace parallax::runtime
