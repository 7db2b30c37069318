// Speed of the built-in simulator: the fetch scene, over and over.
//   bench_world [runs]
// Prints simulated seconds per second of one core and where the time of a run goes; "around" is
// everything but collision and the contact solver.

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <string>

#include "harness/world/ode_simulator.h"
#include "tests/harness/world/fetch_world.h"

namespace {

using parallax::harness::OdeSimulator;
using parallax::harness::State;

struct Totals {
  double wall_s = 0.0, cpu_s = 0.0, simulated_s = 0.0;
};

Totals run(OdeSimulator& simulator, int runs) {
  using Clock = std::chrono::steady_clock;
  Totals totals;
  const Clock::time_point begin = Clock::now();
  const std::clock_t cpu_begin = std::clock();
  for (int i = 0; i < runs; ++i) {
    const double share = (i + 0.5) / runs;
    simulator.reset({{"robot.x", share}, {"box.x", 1.0 + share}}, 1);
    const auto act = [&](const char* name, const State& arguments) {
      totals.simulated_s += simulator.act(name, arguments, 60.0).sim_time_s;
      simulator.observe();
    };
    act("going", {{"target.x", 1.5}});
    act("picking-up", {{"object", std::string("box")}});
    act("going", {{"target.x", 0.5}});
    act("placing", {{"target.x", 0.5}});
  }
  totals.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  totals.cpu_s = static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
  return totals;
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 100;
  OdeSimulator simulator(parallax::harness::fetch_world());
  run(simulator, 5);  // warms caches and the engine's memory

  const Totals plain = run(simulator, runs);
  fmt::print(
      "{} runs, {:.1f} s simulated; wall {:.3f} s, cpu {:.3f} s: {:.0f} times real time per core, "
      "{:.1f} ms a run\n",
      runs, plain.simulated_s, plain.wall_s, plain.cpu_s, plain.simulated_s / plain.cpu_s,
      1e3 * plain.cpu_s / runs);

  simulator.measure_times(true);  // the clock itself costs about 0.1 us a step
  const auto before = simulator.statistics();
  const Totals measured = run(simulator, runs);
  const auto after = simulator.statistics();
  const double collide_s = after.collide_s - before.collide_s;
  const double solve_s = after.solve_s - before.solve_s;
  const double steps = static_cast<double>(after.steps - before.steps);
  fmt::print(
      "per step: collision {:.2f} us, solver {:.2f} us, around {:.2f} us ({:.1f} %); "
      "{:.2f} contacts\n",
      1e6 * collide_s / steps, 1e6 * solve_s / steps,
      1e6 * (measured.wall_s - collide_s - solve_s) / steps,
      100.0 * (measured.wall_s - collide_s - solve_s) / measured.wall_s,
      static_cast<double>(after.contacts - before.contacts) / steps);
  fmt::print("engine messages: {}\n", after.engine_messages);
  return 0;
}
