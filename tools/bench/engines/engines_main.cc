// parallax_engine_table [SCENARIO...]: errors of the machines of docs/internals/physics.md, by
// engine and step; for scenarios, the speed and memory of each engine in simulating their first
// trace.

#include <fmt/core.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "compiler/base/hash.h"
#include "harness/campaign/trial.h"
#include "harness/engine/engine_module.h"
#include "harness/engine/world_check.h"
#include "harness/robot/ode_simulator.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_feed.h"
#include "tools/bench/engines/grips.h"
#include "tools/bench/engines/machines.h"

namespace parallax::tools {
namespace {

using harness::EngineKind;

constexpr double kRounding = 1e-9;
constexpr std::int64_t kSimulations = 10;

void print_machines() {
  const std::vector<double> steps_ms = {4.0, 2.0, 1.0, 0.5};
  fmt::print("| machine | held against | engine | 4 ms | 2 ms | 1 ms | 0.5 ms | order |\n");
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  for (const auto& machine : machines()) {
    for (const auto engine : harness::engines_here()) {
      fmt::print("| {} | {} | {} |", machine.name, machine.held_against, to_string(engine));
      std::vector<double> errors;
      for (const double step_ms : steps_ms) {
        errors.push_back(machine.error(engine, 1e-3 * step_ms));
        if (errors.back() < kRounding) {
          fmt::print(" < 1e-9 {} |", machine.unit);
        } else {
          fmt::print(" {:.2g} {} |", errors.back(), machine.unit);
        }
      }
      if (errors.back() < kRounding) {
        fmt::print(" exact |\n");
      } else if (errors[1] < machine.none) {
        fmt::print(" |\n");
      } else {
        fmt::print(" {:.1f} |\n", std::log2(errors[1] / errors[3]) / 2.0);
      }
    }
  }
}

void print_grips() {
  constexpr double kStep_s = 0.002, kDegree_rad = std::numbers::pi / 180.0;
  fmt::print("\n| what holds, at steps of 2 ms | engine | 0 | 15 | 30 | 45 degrees |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  using Least = double (*)(EngineKind, double);
  const Least grip = [](EngineKind engine, double rad) { return least_grip(engine, kStep_s, rad); };
  const Least slope = [](EngineKind engine, double rad) {
    return least_slope_friction(engine, kStep_s, rad);
  };
  for (const auto& [name, least] :
       {std::pair{"force of a grip", grip}, std::pair{"friction on a slope", slope}}) {
    for (const auto engine : harness::engines_here()) {
      fmt::print("| least {}, by Coulomb's law 1 | {} |", name, to_string(engine));
      for (const double angle : {0.0, 15.0, 30.0, 45.0}) {
        fmt::print(" {:.3f} |", least(engine, angle * kDegree_rad));
      }
      fmt::print("\n");
    }
  }
  for (const auto engine : harness::engines_here()) {
    fmt::print("\ncreep of a load held with twice the force that it needs, {}: {:.2g} mm/s\n",
               to_string(engine), 1e3 * creep_m_s(engine, kStep_s));
  }
}

double processor_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Speed {
  double simulated_s = 0.0, processor_s = 0.0, built_s = 0.0;
  std::int64_t clean = 0;  // that ended at all
};

/// Simulates the first trace several times, in a process of its own.
Speed simulate(const char* file, EngineKind engine) {
  Context context;
  auto loaded = load_scenario_model(file, context);
  if (!loaded) return {};
  loaded->scenario.world.engine = engine;
  if (!harness::check_world(loaded->scenario.world).empty()) return {};
  EnumeratedTraces traces(loaded->compilation.model, context);
  auto trace = traces.next();
  if (!trace || !*trace) return {};
  const double before_s = processor_seconds();
  harness::OdeSimulator simulator(loaded->scenario.world);
  Speed speed;
  speed.built_s = processor_seconds() - before_s;
  const harness::ModelFluents fluents(*traces.symbols());
  auto parts = harness::prepare_trace(loaded->scenario, fluents.ground(), simulator.info(), **trace,
                                      context.sink());
  if (!parts) return {};
  const auto key = base::fnv1a64((*trace)->key);
  const harness::TracePlan plan{std::make_shared<const harness::CampaignTrace>(**std::move(trace)),
                                std::move(parts->calls),
                                std::move(parts->sampler),
                                1,
                                key,
                                100,
                                false};
  const double began_s = processor_seconds();
  for (std::int64_t sample = 1; sample <= kSimulations; ++sample) {
    const auto record = harness::run_sample(plan, sample, simulator, [] { return false; });
    if (record->status == harness::SampleStatus::kOk) ++speed.clean;
    for (const auto& outcome : record->outcomes) speed.simulated_s += outcome.sim_time_s;
  }
  speed.processor_s = processor_seconds() - began_s;
  return speed;
}

void print_speed(const char* file, EngineKind engine) {
  int ends[2];
  if (::pipe(ends) != 0) return;
  const pid_t child = ::fork();
  if (child == 0) {
    const Speed speed = simulate(file, engine);
    const bool told = ::write(ends[1], &speed, sizeof speed) == sizeof speed;
    ::_exit(told ? 0 : 1);
  }
  ::close(ends[1]);  // else a child that dies leaves the read waiting
  Speed speed;
  const bool read = ::read(ends[0], &speed, sizeof speed) == sizeof speed;
  int status = 0;
  rusage usage{};
  ::wait4(child, &status, 0, &usage);
  ::close(ends[0]);
  if (!read || speed.processor_s == 0.0) {
    return fmt::print("| {} | {} | not for this engine | | | |\n", file, to_string(engine));
  }
  fmt::print("| {} | {} | {:.1f} | {} of {} | {:.0f} ms | {:.0f} MB |\n", file, to_string(engine),
             speed.simulated_s / speed.processor_s, speed.clean, kSimulations, 1e3 * speed.built_s,
             static_cast<double>(usage.ru_maxrss) / 1024.0);
}

}  // namespace
}  // namespace parallax::tools

int main(int count, char** arguments) {
  using namespace parallax::tools;
  if (count == 1) {
    print_machines();
    print_grips();
    return 0;
  }
  fmt::print("| scenario | engine | times real time | ended | building | memory |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  std::fflush(stdout);
  for (int i = 1; i < count; ++i) {
    for (const auto engine : parallax::harness::engines_here()) {
      print_speed(arguments[i], engine);
      std::fflush(stdout);
    }
  }
  return 0;
}
