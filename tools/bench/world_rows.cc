// The two-region world: first trace, simulation, worker processes, the demo as a whole; a
// simulation of the kitchen.

#include <fmt/core.h>

#include <chrono>
#include <ctime>
#include <functional>
#include <utility>
#include <vector>

#include "harness/campaign/judge.h"
#include "harness/campaign/sample_runner.h"
#include "harness/robot/ode_simulator.h"
#include "harness/simulator/process_simulator.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_feed.h"
#include "tools/bench/bench.h"

namespace parallax::tools {
namespace {

constexpr const char* kScenario = PARALLAX_SOURCE_DIR "/scenarios/two_regions/scenario.yaml";
constexpr const char* kKitchenScenario =
    PARALLAX_SOURCE_DIR "/scenarios/kitchen/plan2_modified.yaml";
constexpr int kRepetitions = 15;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

using Acts = std::vector<harness::ActionCall>;

/// The first trace, what it asks of the simulator, and the model's fluents.
struct FirstTrace {
  harness::CampaignTrace trace;
  Acts acts;
  harness::ModelFluents fluents;
};

FirstTrace first_trace(const ScenarioModel& loaded, Context& context) {
  EnumeratedTraces traces(loaded.compilation.model, context);
  auto trace = **traces.next();
  auto acts = *harness::action_calls(loaded.scenario, trace, context.sink());
  return {std::move(trace), std::move(acts), harness::ModelFluents(*traces.symbols())};
}

struct Simulated {
  double time_s = 0.0;
  std::vector<harness::State> observations;
};

/// One whole simulation.
Simulated simulate(harness::Simulator& simulator, const Acts& acts, const harness::State& start) {
  Simulated out;
  simulator.reset(start, 1);
  out.observations.push_back(simulator.observe());
  for (const auto& act : acts) {
    out.time_s += simulator.act(act.controller, act.arguments, act.time_limit_s).sim_time_s;
    out.observations.push_back(simulator.observe());
  }
  return out;
}

/// Starts that differ from repetition to repetition.
using Starts = std::function<harness::State(int repetition)>;

harness::State box_start(int repetition) {
  return {{"robot.x", 0.4}, {"box.x", 1.1 + 0.05 * repetition}};
}

harness::State kitchen_start(int repetition) {
  return {{"robot.x", 0.65 + 0.01 * repetition}, {"robot.y", 0.06}};
}

/// A figure without a peer, and not a program's run.
void add_figure(Bench& bench, const char* name, std::string note) {
  bench.add({"", name, {}, std::nullopt, std::move(note)});
}

void measure_scenario_trace(Bench& bench) {
  std::vector<double> all, solving;
  for (int i = 0; i < kRepetitions; ++i) {
    Context context;
    all.push_back(seconds_of([&] {
      const auto loaded = load_scenario_model(kScenario, context);
      solving.push_back(seconds_of([&] {
        EnumeratedTraces traces(loaded->compilation.model, context);
        (void)traces.next();
      }));
    }));
  }
  add_figure(bench, "first trace",
             fmt::format("{:.2f} ms, of which the solver and decoding {:.2f} ms", 1e3 * median(all),
                         1e3 * median(solving)));
}

void measure_simulation(Bench& bench, harness::OdeSimulator& simulator, const ScenarioModel& loaded,
                        const FirstTrace& first, const Starts& start) {
  simulator.measure_times(true);
  double simulated_s = 0.0;
  std::vector<Simulated> runs;
  const double processor_before_s = processor_seconds();
  const double wall_s = seconds_of([&] {
    for (int i = 0; i < kRepetitions; ++i) {
      runs.push_back(simulate(simulator, first.acts, start(i)));
      simulated_s += runs.back().time_s;
    }
  });
  const double processor_s = processor_seconds() - processor_before_s;
  const double judging_before_s = processor_seconds();
  for (const auto& run : runs) {
    harness::judge(*loaded.scenario.mapping, first.fluents, first.trace, run.observations);
  }
  const double judging_s = processor_seconds() - judging_before_s;
  simulator.measure_times(false);
  const auto& statistics = simulator.statistics();
  const double engine_s = statistics.collide_s + statistics.solve_s;
  add_figure(bench, "simulation",
             fmt::format("{:.1f} times real time at {:.0f} ms steps, by processor time",
                         simulated_s / processor_s, 1e3 * loaded.scenario.world.solver.timestep_s));
  add_figure(bench, "around the engine",
             fmt::format("{:.1f} % of a run (solver {:.1f} %, collision {:.1f} %)",
                         100 * (1 - engine_s / wall_s), 100 * statistics.solve_s / wall_s,
                         100 * statistics.collide_s / wall_s));
  add_figure(bench, "every step compared",
             fmt::format("{:.2f} % of the simulation's processor time, {} states of {} fluents",
                         100 * judging_s / processor_s, first.trace.points.size(),
                         first.fluents.ground().size()));
}

void measure_worker(Bench& bench, harness::OdeSimulator& simulator, const Acts& acts) {
  harness::ProcessOptions options;
  options.command = {parallax_program(), "worker", kScenario};
  harness::ProcessSimulator process(options);
  const double start_s = seconds_of([&] { process.info(); });
  std::vector<double> ratios;
  for (int i = 0; i < kRepetitions; ++i) {
    const harness::State start = box_start(i);
    const double inside_s = seconds_of([&] { simulate(simulator, acts, start); });
    ratios.push_back(seconds_of([&] { simulate(process, acts, start); }) / inside_s);
  }
  add_figure(bench, "worker process",
             fmt::format("{:.3f} times the time of the same run in this process; start {:.1f} ms",
                         median(ratios), 1e3 * start_s));
}

}  // namespace

void measure_world(Bench& bench) {
  bench.begin("the two-region world");
  measure_scenario_trace(bench);
  Context context;
  const auto loaded = load_scenario_model(kScenario, context);
  const auto first = first_trace(*loaded, context);
  harness::OdeSimulator simulator(loaded->scenario.world);
  measure_simulation(bench, simulator, *loaded, first, box_start);
  measure_worker(bench, simulator, first.acts);

  bench.begin("the kitchen, first trace of the repaired plan");
  const auto kitchen = load_scenario_model(kKitchenScenario, context);
  harness::OdeSimulator kitchen_simulator(kitchen->scenario.world);
  measure_simulation(bench, kitchen_simulator, *kitchen, first_trace(*kitchen, context),
                     kitchen_start);
}

void measure_demo(Bench& bench) {
  bench.begin("the demo, without the build");
  bench.compare("tools/demo --no-build",
                {{"demo", {PARALLAX_SOURCE_DIR "/tools/demo", "--no-build"}, "", {0}, {}}});
}

}  // namespace parallax::tools
