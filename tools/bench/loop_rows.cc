// The kitchen's repaired plan in closed loop, compared with open loop over the same actions from
// the same starts: the cost of walking through the plan and asking the model.

#include <fmt/core.h>

#include <ctime>
#include <memory>
#include <utility>
#include <vector>

#include "harness/campaign/judge.h"
#include "harness/campaign/loop_judge.h"
#include "harness/campaign/loop_samples.h"
#include "harness/campaign/loop_stream.h"
#include "harness/robot/ode_simulator.h"
#include "tools/app/closed_loop.h"
#include "tools/app/scenario_model.h"
#include "tools/bench/bench.h"

namespace parallax::tools {
namespace {

constexpr const char* kLoopScenario = PARALLAX_SOURCE_DIR "/scenarios/kitchen/plan2_modified.yaml";
constexpr int kExecutions = 5;

double loop_processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// An initial state, and how starts in it are drawn.
std::vector<harness::LoopStart> loop_starts(const ScenarioModel& loaded, ClosedLoop& loop,
                                            const harness::ModelFluents& fluents,
                                            const harness::SimulatorInfo& info, Context& context) {
  std::vector<harness::LoopStart> starts;
  auto states = loop.initial_states(harness::compared_fluents(loaded.scenario, fluents));
  for (auto& holds : (*states)->holds) {
    auto state = harness::LoopStream::start_state(loop, std::move(holds));
    auto parts =
        harness::prepare_trace(loaded.scenario, fluents.ground(), info, *state, context.sink());
    starts.push_back({std::move(state), std::move(parts->sampler)});
  }
  return starts;
}

}  // namespace

void measure_loop(Bench& bench) {
  bench.begin("the kitchen, the repaired plan in closed loop");
  Context context;
  const auto loaded = load_scenario_model(
      kLoopScenario, context, {.as_run = true, .execution = harness::Execution::kClosedLoop});
  const auto loop = *ClosedLoop::make(*loaded, context);
  const harness::ModelFluents fluents(*loop->symbols());
  harness::OdeSimulator simulator(loaded->scenario.world);
  const harness::LoopSamples samples(
      loaded->scenario, loop->plan(),
      loop_starts(*loaded, *loop, fluents, simulator.info(), context), {}, 1, loop->max_performs(),
      false);
  const auto never = [] { return false; };
  double simulated_s = 0.0, closed_s = 0.0, judging_s = 0.0, open_s = 0.0;
  bool clean = true;
  for (int sample = 1; sample <= kExecutions; ++sample) {
    double before_s = loop_processor_seconds();
    const auto record = *samples.make(sample, simulator, never);
    closed_s += loop_processor_seconds() - before_s;
    before_s = loop_processor_seconds();
    clean =
        judge_path(*loaded->scenario.mapping, fluents, *loop, record, loaded->scenario.comparison())
                .admitted == base::Known::kYes &&
        clean;
    judging_s += loop_processor_seconds() - before_s;
    for (const auto& outcome : record.outcomes) simulated_s += outcome.sim_time_s;
    before_s = loop_processor_seconds();
    (void)samples.repeat(record, simulator, never);
    open_s += loop_processor_seconds() - before_s;
  }
  bench.add({"",
             "executed and judged",
             {},
             std::nullopt,
             fmt::format("{:.3f} times the processor time of the same actions in open loop, per "
                         "simulated second; judging {:.2f} %",
                         (closed_s + judging_s) / open_s, 100 * judging_s / open_s)});
  bench.add({"",
             "executions",
             {},
             std::nullopt,
             fmt::format("{}, {:.0f} s simulated, {}", kExecutions, simulated_s,
                         clean ? "all clean" : "not all clean")});
}

}  // namespace parallax::tools
