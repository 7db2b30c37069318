#pragma once

#include <istream>
#include <string>

#include "runtime/proof/drat_checker.h"
#include "runtime/proof/proof_reader.h"

namespace parallax::runtime {

enum class ProofVerdict : std::uint8_t {
  kAccepted,    // the formula has no model
  kRejected,    // a step does not follow, or something is malformed, or no contradiction is reached
  kNotFinished  // stopped, or beyond the limits
};

struct ProofReport {
  ProofVerdict verdict = ProofVerdict::kRejected;
  std::string reason;  // empty if accepted: "step 17 adds a clause that does not follow: 3 -5 0"
  ProofStatistics statistics;
};

/// Does the DRAT proof show that the DIMACS formula has no model? Both are read to their end: what
/// follows a contradiction still has to be well-formed. Time is what the steps cost; memory is the
/// clauses held at one time.
ProofReport check_proof(std::istream& formula, std::istream& proof, DratFormat format,
                        const ProofLimits& limits = {});

}  // namespace parallax::runtime
