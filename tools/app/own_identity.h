#pragma once

#include <string>

#include "harness/campaign/campaign.h"
#include "harness/cluster/program_identity.h"
#include "harness/config/scenario.h"

namespace parallax::tools {

/// Sixteen hexadecimal digits that tell machines apart which simulate differently: a hash over
/// results of the mathematical library and of the engine, both for fixed inputs.
std::string own_arithmetic(harness::EngineKind engine = harness::EngineKind::kOde);

/// The identity of this process for simulations of `scenario`, which has been loaded and with it
/// the modules that read its files; the module of its engine is loaded here.
harness::ProgramIdentity own_identity(const harness::Scenario& scenario);

/// Writes down the machine and the build that the run of `options` is made with.
void record_identity(const harness::Scenario& scenario, harness::CampaignOptions& options);

}  // namespace parallax::tools
