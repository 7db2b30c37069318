#include "harness/campaign/prepared_trace.h"

#include <algorithm>
#include <utility>

#include "compiler/base/codes/scenarios.h"
#include "harness/region/state_mapping.h"

namespace parallax::harness {
namespace {

/// Every drawn variable must be one that the simulator can start with.
base::Status check_settable(const Scenario& scenario, const StartCuboid& start,
                            const SimulatorInfo& simulator, base::DiagnosticSink& sink) {
  const auto& known = simulator.parameters;
  bool fine = true;
  for (const auto& dimension : start.dimensions) {
    const auto found = std::find_if(known.begin(), known.end(), [&](const Parameter& parameter) {
      return parameter.name == dimension.variable;
    });
    if (known.empty() || (found != known.end() && found->settable)) continue;
    sink.error(codes::kVariableNotSettable, scenario.sampled_at(dimension.variable),
               dimension.variable);
    fine = false;
  }
  if (!fine) return sink.already_reported();
  return base::Unit{};
}

}  // namespace

base::Result<PreparedTrace> prepare_trace(const Scenario& scenario,
                                          const std::vector<GroundFluent>& fluents,
                                          const SimulatorInfo& simulator,
                                          const CampaignTrace& trace, base::DiagnosticSink& sink) {
  const auto true_at_start = trace.holds(0);
  auto sampler = start_sampler(
      scenario, fluents, std::set<std::string>(true_at_start.begin(), true_at_start.end()), sink);
  if (sampler && !check_settable(scenario, sampler->cuboid(), simulator, sink)) {
    return sink.already_reported();
  }
  auto calls = action_calls(scenario, trace, sink);
  if (!calls || !sampler) return sink.already_reported();
  auto start = sampler->cuboid();
  return PreparedTrace{std::move(start), std::move(*calls), std::move(*sampler)};
}

base::Result<Sampler> start_sampler(const Scenario& scenario,
                                    const std::vector<GroundFluent>& fluents,
                                    const std::set<std::string>& true_at_start,
                                    base::DiagnosticSink& sink) {
  auto start = scenario.mapping->start_cuboid(fluents, true_at_start, scenario.sampling,
                                              scenario.sampling_source, sink);
  if (!start) return sink.already_reported();
  return Sampler::make(*std::move(start), scenario.sampling_inset_m, scenario.sampling_source, sink,
                       &scenario.law);
}

std::optional<std::string> why_no_start(const Scenario& scenario,
                                        const std::vector<GroundFluent>& fluents,
                                        const std::set<std::string>& true_at_start) {
  base::DiagnosticSink unread;
  if (start_sampler(scenario, fluents, true_at_start, unread)) return std::nullopt;
  const auto said = unread.sorted();
  return said.empty() ? "no start" : said.front().message;
}

}  // namespace parallax::harness
