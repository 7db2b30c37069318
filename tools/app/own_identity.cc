#include "tools/app/own_identity.h"

#include <utility>

#include "compiler/base/sha256.h"
#include "harness/engine/engine_arithmetic.h"
#include "harness/simulator/arithmetic.h"
#include "tools/app/version.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kDigits = 16;

}  // namespace

std::string own_arithmetic(harness::EngineKind engine) {
  const auto results = harness::arithmetic_digits() + harness::engine_digits(engine);
  return base::sha256_hex(results).substr(0, kDigits);
}

harness::ProgramIdentity own_identity(const harness::Scenario& scenario) {
  // A scenario with another simulator has the default engine here, which takes no part.
  auto arithmetic = own_arithmetic(scenario.simulator.engine);
  return harness::this_program(kVersion, std::move(arithmetic));
}

void record_identity(const harness::Scenario& scenario, harness::CampaignOptions& options) {
  auto self = own_identity(scenario);
  options.arithmetic = std::move(self.arithmetic);
  options.build = std::move(self.build);
}

}  // namespace parallax::tools
