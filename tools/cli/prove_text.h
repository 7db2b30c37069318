#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/geometry_proof/certificate.h"
#include "harness/geometry_proof/held_against_simulation.h"

namespace parallax::tools {

// What `parallax prove` prints. `simulated`: what simulations showed, test by test; may be empty.

/// What was proved, as JSON without the boxes, and as text. `events`: of the trace.
std::string proof_json(const harness::Certificate& certificate,
                       const std::vector<harness::SimulatedTest>& simulated);
std::string proof_text(const harness::Certificate& certificate, std::string_view events,
                       const std::vector<harness::SimulatedTest>& simulated);

/// What a check confirmed, of which tests, and under which assumptions.
std::string check_json(const harness::Certificate& certificate,
                       const harness::CertificateCheck& result,
                       const std::vector<harness::SimulatedTest>& simulated);
std::string check_text(const harness::Certificate& certificate,
                       const harness::CertificateCheck& result,
                       const std::vector<harness::SimulatedTest>& simulated);

}  // namespace parallax::tools
