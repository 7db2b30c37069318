#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/campaign/start_result.h"
#include "harness/geometry_proof/certificate.h"
#include "harness/geometry_proof/held_against_simulation.h"

namespace parallax::tools {

// Output of `parallax prove`. `simulated`: the results of simulations by test; may be empty.

/// The proof of a trace from one of its initial states.
struct ProvedState {
  harness::GeometryCertificate certificate;
  std::vector<harness::SimulatedTest> simulated;
};

/// The proofs of a trace from its initial states, or from the one that was asked for.
struct Proved {
  std::int64_t trace = 0;
  std::string events;
  harness::StartResult about;  // how many initial states there are
  bool one_asked = false;
  std::vector<ProvedState> states;

  /// Is there a proof for each state that was asked for and that a start can realise?
  bool are_all() const;
};

/// Proofs as JSON, without their boxes, and as text.
std::string proof_json(const Proved& proved);
std::string proof_text(const Proved& proved);

/// The result of a check: confirmed tests and their assumptions.
std::string check_json(const harness::GeometryCertificate& certificate,
                       const harness::StartResult& about, const harness::CertificateCheck& result,
                       const std::vector<harness::SimulatedTest>& simulated);
std::string check_text(const harness::GeometryCertificate& certificate,
                       const harness::StartResult& about, const harness::CertificateCheck& result,
                       const std::vector<harness::SimulatedTest>& simulated);

}  // namespace parallax::tools
