// The two-region world: first trace, simulation, worker processes, the demo as a whole.

#include <fmt/core.h>

#include <chrono>
#include <functional>
#include <vector>

#include "harness/world/ode_simulator.h"
#include "harness/world/process_simulator.h"
#include "tools/bench/bench.h"
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

/// A figure without a peer, and not a program's run.
void add_figure(Bench& bench, const char* name, std::string note) {
  bench.add({"", name, {}, std::nullopt, std::move(note)});
}

void measure_scenario_trace(Bench& bench) {
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
  add_figure(bench, "first trace",
             fmt::format("{:.2f} ms, of which the solver and decoding {:.2f} ms", 1e3 * median(all),
                         1e3 * median(solving)));
}

void measure_simulation(Bench& bench, harness::OdeSimulator& simulator, const ScenarioModel& loaded,
                        const std::vector<Act>& acts) {
  simulator.measure_times(true);
  double simulated_s = 0.0;
  const double wall_s = seconds_of([&] {
    for (int i = 0; i < kRepetitions; ++i) {
      simulated_s += simulate(simulator, acts, 1.1 + 0.05 * i);
    }
  });
  simulator.measure_times(false);
  const auto& statistics = simulator.statistics();
  const double engine_s = statistics.collide_s + statistics.solve_s;
  add_figure(bench, "simulation",
             fmt::format("{:.1f} times real time at {:.0f} ms steps, one core",
                         simulated_s / wall_s, 1e3 * loaded.scenario.world.solver.timestep_s));
  add_figure(bench, "around the engine",
             fmt::format("{:.1f} % of a run (solver {:.1f} %, collision {:.1f} %)",
                         100 * (1 - engine_s / wall_s), 100 * statistics.solve_s / wall_s,
                         100 * statistics.collide_s / wall_s));
}

void measure_worker(Bench& bench, harness::OdeSimulator& simulator, const std::vector<Act>& acts) {
  harness::ProcessOptions options;
  options.command = {parallax_program(), "worker", kScenario};
  harness::ProcessSimulator process(options);
  const double start_s = seconds_of([&] { process.info(); });
  std::vector<double> ratios;
  for (int i = 0; i < kRepetitions; ++i) {
    const double box_x_m = 1.1 + 0.05 * i;
    const double inside_s = seconds_of([&] { simulate(simulator, acts, box_x_m); });
    ratios.push_back(seconds_of([&] { simulate(process, acts, box_x_m); }) / inside_s);
  }
  add_figure(bench, "worker process",
             fmt::format("{:.3f} times the time of the same run in this process; start {:.1f} ms",
                         median(ratios), 1e3 * start_s));
}

}  // namespace

void measure_world(Bench& bench) {
  bench.begin("the two-region world");
  measure_scenario_trace(bench);
  Invocation invocation{CommonOptions{}};
  const auto loaded = load_scenario_model(kScenario, invocation);
  const auto acts = acts_of(*loaded, invocation);
  harness::OdeSimulator simulator(loaded->scenario.world);
  measure_simulation(bench, simulator, *loaded, acts);
  measure_worker(bench, simulator, acts);
}

void measure_demo(Bench& bench) {
  bench.begin("the demo, without the build");
  bench.compare("tools/demo --no-build",
                {{"demo", {PARALLAX_SOURCE_DIR "/tools/demo", "--no-build"}, "", {0}, {}}});
}

}  // namespace parallax::tools
