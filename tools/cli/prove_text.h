#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/geometry_proof/certificate.h"
#include "harness/geometry_proof/held_against_simulation.h"

namespace parallax::tools {

// Output of `parallax prove`. `simulated`: the results of simulations by test; may be empty.

/// A proof as JSON, without its boxes, and as text. `events`: those of the trace.
std::string proof_json(const harness::Certificate& certificate,
                       const std::vector<harness::SimulatedTest>& simulated);
std::string proof_text(const harness::Certificate& certificate, std::string_view events,
                       const std::vector<harness::SimulatedTest>& simulated);

/// The result of a check: confirmed tests and their assumptions.
std::string check_json(const harness::Certificate& certificate,
                       const harness::CertificateCheck& result,
                       const std::vector<harness::SimulatedTest>& simulated);
std::string check_text(const harness::Certificate& certificate,
                       const harness::CertificateCheck& result,
                       const std::vector<harness::SimulatedTest>& simulated);

}  // namespace parallax::tools
