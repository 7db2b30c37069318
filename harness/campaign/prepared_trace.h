#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "harness/campaign/sample_runner.h"
#include "harness/campaign/trace_input.h"
#include "harness/config/scenario.h"
#include "harness/sampling/sampler.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// The data that a trace is simulated with.
struct PreparedTrace {
  StartCuboid start;
  std::vector<ActionCall> calls;
  Sampler sampler;
};
/// Derives the data. Reports what the parts report, and kVariableNotSettable for a start that the
/// simulator cannot be put into.
base::Result<PreparedTrace> prepare_trace(const Scenario& scenario,
                                          const std::vector<GroundFluent>& fluents,
                                          const SimulatorInfo& simulator,
                                          const CampaignTrace& trace, base::DiagnosticSink& sink);

/// Makes the sampler for the starts of an initial state. Reports what the mapping and the sampler
/// report.
base::Result<Sampler> start_sampler(const Scenario& scenario,
                                    const std::vector<GroundFluent>& fluents,
                                    const std::set<std::string>& true_at_start,
                                    base::DiagnosticSink& sink);

/// Why no start of the world has this initial state, in a sentence; none: some start has it.
std::optional<std::string> why_no_start(const Scenario& scenario,
                                        const std::vector<GroundFluent>& fluents,
                                        const std::set<std::string>& true_at_start);

}  // namespace parallax::harness
