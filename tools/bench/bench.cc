// Speed of the two-region world, measured in one run: tools/bench/run prints this program's table.

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

#include "harness/world/ode_simulator.h"
#include "harness/world/process_simulator.h"
#include "tools/cli/scenario_model.h"
#include "tools/cli/trace_feed.h"

namespace parallax::tools {
namespace {

constexpr const char* kScenario = PARALLAX_SOURCE_DIR "/scenarios/two_regions/scenario.yaml";
constexpr int kRepetitions = 15;

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// The acts of the example's trace: controller, arguments, limit.
struct Act {
  std::string controller;
  harness::State arguments;
  double limit_s = 0.0;
};

std::vector<Act> acts_of(const ScenarioModel& loaded, Invocation& invocation) {
  EnumeratedTraces traces(loaded.compilation.model, invocation);
  const auto trace = traces.next();
  std::vector<Act> acts;
  for (const auto& event : (*trace)->events) {
    for (const auto& action : loaded.scenario.actions) {
      if (action.event != event.symbol) continue;
      Act act{action.controller, action.arguments, action.time_limit_s};
      for (const auto& [name, value] : event.plan_arguments) act.arguments[name] = value;
      acts.push_back(std::move(act));
    }
  }
  return acts;
}

/// One whole simulation; returns the simulated seconds.
double simulate(harness::Simulator& simulator, const std::vector<Act>& acts, double box_x_m) {
  double simulated_s = 0.0;
  simulator.reset({{"robot.x", 0.4}, {"box.x", box_x_m}}, 1);
  simulator.observe();
  for (const auto& act : acts) {
    simulated_s += simulator.act(act.controller, act.arguments, act.limit_s).sim_time_s;
    simulator.observe();
  }
  return simulated_s;
}

void bench_first_trace() {
  std::vector<double> all, solving;
  for (int i = 0; i < kRepetitions; ++i) {
    Invocation invocation{CommonOptions{}};
    all.push_back(seconds_of([&] {
      const auto loaded = load_scenario_model(kScenario, invocation);
      solving.push_back(seconds_of([&] {
        EnumeratedTraces traces(loaded->compilation.model, invocation);
        (void)traces.next();
      }));
    }));
  }
  fmt::print("first trace            {:8.2f} ms, of which the solver and decoding {:.2f} ms\n",
             1e3 * median(all), 1e3 * median(solving));
}

void bench_world() {
  Invocation invocation{CommonOptions{}};
  const auto loaded = load_scenario_model(kScenario, invocation);
  const auto acts = acts_of(*loaded, invocation);
  harness::OdeSimulator simulator(loaded->scenario.world);
  simulator.measure_times(true);
  double simulated_s = 0.0;
  const double wall_s = seconds_of([&] {
    for (int i = 0; i < kRepetitions; ++i) {
      simulated_s += simulate(simulator, acts, 1.1 + 0.05 * i);
    }
  });
  const auto& statistics = simulator.statistics();
  const double engine_s = statistics.collide_s + statistics.solve_s;
  fmt::print("simulation             {:8.1f} times real time at {:.0f} ms steps, one core\n",
             simulated_s / wall_s, 1e3 * loaded->scenario.world.solver.timestep_s);
  fmt::print("around the engine      {:8.1f} % of a run (solver {:.1f} %, collision {:.1f} %)\n",
             100 * (1 - engine_s / wall_s), 100 * statistics.solve_s / wall_s,
             100 * statistics.collide_s / wall_s);

  harness::ProcessOptions options;
  options.command = {PARALLAX_BINARY_DIR "/parallax", "worker", kScenario};
  harness::ProcessSimulator process(options);
  const double start_s = seconds_of([&] { process.info(); });
  std::vector<double> ratios;
  simulator.measure_times(false);
  for (int i = 0; i < kRepetitions; ++i) {
    const double box_x_m = 1.1 + 0.05 * i;
    const double inside_s = seconds_of([&] { simulate(simulator, acts, box_x_m); });
    ratios.push_back(seconds_of([&] { simulate(process, acts, box_x_m); }) / inside_s);
  }
  fmt::print(
      "worker process         {:8.3f} times the time of the same run in this process; "
      "start {:.1f} ms\n",
      median(ratios), 1e3 * start_s);
}

}  // namespace
}  // namespace parallax::tools

int main() {
  parallax::tools::bench_first_trace();
  parallax::tools::bench_world();
  return 0;
}
