#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "compiler/base/diagnostic.h"
#include "runtime/certify/completeness_claim.h"
#include "runtime/certify/proof_files.h"
#include "runtime/proof/check_proof.h"

namespace parallax::runtime {

struct Certificate {
  ProofVerdict verdict = ProofVerdict::kNotFinished;
  ProofStatistics statistics;
  std::int64_t proof_bytes = 0;
};

/// Writes the claim and a proof of it, made by a solver that starts afresh, and has both checked as
/// they are on the disk. The files are kept if the proof is accepted. Reports kFileNotWritable;
/// kProofRejected, also where the solver finds a further trace; kProofNotChecked if solver or
/// checker were stopped.
Certificate prove(const CompletenessClaim& claim, ProofFiles& files, const ProofLimits& limits,
                  base::DiagnosticSink& sink);

}  // namespace parallax::runtime
