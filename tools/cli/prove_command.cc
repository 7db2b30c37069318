#include <memory>

#include "compiler/base/diagnostic_codes.h"
#include "harness/campaign/trial.h"
#include "harness/geometry_proof/trace_proof.h"
#include "harness/robot/ode_simulator.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_feed.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {
struct ProveOptions {
  std::string scenario;
  std::int64_t trace = 1;
  std::int64_t boxes = 20000;
};

int run_prove(const ProveOptions& options, Invocation& invocation) {
  auto loaded = load_scenario_model(options.scenario, invocation);
  if (!loaded) return 0;
  const auto& scenario = loaded->scenario;
  EnumeratedTraces traces(loaded->compilation.model, invocation);
  std::optional<harness::CampaignTrace> found;
  while (!found) {
    auto trace = traces.next();
    if (!trace) return 0;
    if (!*trace) return 0;
    if ((*trace)->number == options.trace) found = **trace;
  }
  harness::OdeSimulator simulator(scenario.world);
  const harness::ModelFluents fluents(*traces.symbols());
  auto prepared = harness::prepare_trace(scenario, fluents.ground(), simulator.info(), *found,
                                         invocation.sink());
  if (!prepared) return 0;
  const auto layout = harness::lay_out(scenario.world);
  std::vector<harness::ProofAction> actions;
  for (std::size_t i = 0; i < prepared->calls.size(); ++i) {
    actions.push_back({found->event(i), prepared->calls[i].controller, prepared->calls[i].arguments});
  }
  const auto all = harness::provable_actions(scenario.world, layout, prepared->start, actions, {});
  for (const auto& action : all) {
    if (action.tests.empty()) {
      invocation.result(fmt::format("{} {} {}: {}\n", action.number, action.event, action.controller, action.left_to_simulation));
    }
    for (const auto& test : action.tests) {
      harness::ProofLimits limits;
      limits.boxes = options.boxes;
      const auto result = harness::prove(test->check(), test->scene().whole(), limits);
      invocation.result(fmt::format("{} {} {}: safe {} refuted {} open {} boxes {} examined {}\n", action.number, action.event, action.controller, result.safe, result.refuted, result.open, result.boxes.size(), result.examined));
    }
  }
  return 0;
}
}  // namespace

Command prove_command() {
  auto options = std::make_shared<ProveOptions>();
  OptionTable command("prove", "x");
  command.option("scenario", options->scenario, "Scenario file (YAML)").required();
  command.option("--trace", options->trace, "");
  command.option("--boxes", options->boxes, "");
  return {std::move(command),
          [options](Invocation& invocation) { return run_prove(*options, invocation); }};
}
}  // namespace parallax::tools
