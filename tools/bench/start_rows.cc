// How many executions it takes to go through all of a plan that its model can go through, with
// starts drawn uniformly and with starts that the solver chooses. The world is the model itself.

#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "harness/campaign/loop_samples.h"
#include "harness/campaign/loop_stream.h"
#include "harness/campaign/sample_runner.h"
#include "harness/campaign/trial.h"
#include "tools/app/closed_loop.h"
#include "tools/app/simulator_factory.h"
#include "tools/app/start_guide.h"
#include "tools/bench/bench.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSeeds = 20;
constexpr std::int64_t kMostRuns = 5000;
constexpr int kUnlimited = 1 << 20;

struct PlayedPlan {
  const char* name;
  const char* models;  // the first one is the world, too
  const char* bind;
};
constexpr PlayedPlan kPlans[] = {
    {"fetch_bowl", "domain.e, start.e", "robot.bind"},
    {"lay_the_table", "domain.e, start.e", "robot.bind"},
    {"nested_failures", "domain.e, start.e", "robot.bind"},
    {"open_what_is_shut", "domain.e, start_untidy.e", "robot.bind"},
    {"restock_shelf", "shelf.e", "shelf.bind"},
    {"plan1", "domain.e, start.e", "robot.bind"},
    {"plan2", "domain.e, start.e", "robot.bind"},
    {"plan2_modified", "domain_modified.e, start_modified.e", "robot_modified.bind"},
    {"plan3", "domain.e, start.e", "robot.bind"},
};

/// The kitchen without its physics, and the plans of the tests, in one folder.
fs::path play_folder(const Bench& bench) {
  const fs::path folder = bench.path("play");
  fs::create_directory(folder);
  const fs::path source = PARALLAX_SOURCE_DIR;
  for (const auto* from : {"scenarios/kitchen", "tests/plans"}) {
    for (const auto& entry : fs::directory_iterator(source / from)) {
      if (entry.is_regular_file()) fs::copy_file(entry.path(), folder / entry.path().filename());
    }
  }
  std::stringstream common;
  common << std::ifstream(source / "scenarios/kitchen/household.yaml").rdbuf();
  const auto text = common.str();
  std::ofstream(folder / "regions.yaml") << text.substr(0, text.find("\nmapping:") + 1);
  for (const auto& plan : kPlans) {
    const std::string models = plan.models;
    std::ofstream out(folder / fmt::format("play_{}.yaml", plan.name));
    if (models != "shelf.e") out << "include: regions.yaml\n";
    out << fmt::format(
        "model: [{}]\nplan: {}.lisp\nbind: {}\nhorizon: 10\nsimulator: {{model: {}}}\n", models,
        plan.name, plan.bind, models.substr(0, models.find(',')));
  }
  return folder;
}

struct Played {
  std::int64_t starts = 0;
  std::size_t coverable = 0;
  double prepared_ms = 0.0;
  double runs = 0.0;  // on average over the seeds
  bool covered = true;
};

/// Uses the feed as LoopStream does, without judging.
Played play(const ScenarioModel& loaded, bool guided, Context& context) {
  Played out;
  auto loop = *ClosedLoop::make(loaded, context);
  const harness::ModelFluents fluents(*loop->symbols());
  const auto compared = harness::compared_fluents(loaded.scenario, fluents);
  const auto states = (**loop->initial_states(compared)).holds;
  const auto simulator = simulator_factory(loaded, {}, context.stop())();
  out.starts = static_cast<std::int64_t>(states.size());
  std::vector<harness::LoopStart> starts;
  for (const auto& holds : states) {
    auto state = harness::LoopStream::start_state(*loop, holds);
    auto parts = *harness::prepare_trace(loaded.scenario, fluents.ground(), simulator->info(),
                                         *state, context.sink());
    starts.push_back({std::move(state), std::move(parts.sampler)});
  }
  const PlanCoverage plan(*loaded.compilation.plan, *loaded.compilation.typed, context.files());
  Stopwatch preparing;
  const auto candidates = start_candidates(loaded, *loop, plan, states, compared);
  out.prepared_ms = preparing.lap_ms();
  out.coverable = candidates.coverable.size();
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const harness::LoopSamples samples(loaded.scenario, loop->plan(), starts, {}, seed,
                                       loop->max_performs(), true);
    ScenarioStartGuide guide(candidates, plan, loop->scenario_plan(), seed, kUnlimited);
    std::int64_t run = 0;
    while (!guide.uncovered().empty() && run < kMostRuns) {
      const auto chosen = guided ? guide.next(++run) : (++run, std::nullopt);
      guide.tell(*samples.make_from(run, chosen, *simulator, [] { return false; }));
    }
    out.runs += static_cast<double>(run) / static_cast<double>(kSeeds);
    out.covered = out.covered && guide.uncovered().empty();
  }
  return out;
}

}  // namespace

void measure_starts(Bench& bench) {
  bench.begin("executions until all of a plan is covered that its model can cover");
  const auto folder = play_folder(bench);
  double uniform_runs = 0.0, guided_runs = 0.0;
  for (const auto& plan : kPlans) {
    Context context;
    const auto loaded =
        load_scenario_model(folder / fmt::format("play_{}.yaml", plan.name), context,
                            {.as_run = true, .execution = harness::Execution::kClosedLoop});
    const auto uniform = play(*loaded, false, context), guided = play(*loaded, true, context);
    uniform_runs += uniform.runs;
    guided_runs += guided.runs;
    bench.add({"",
               plan.name,
               {},
               std::nullopt,
               fmt::format("{} starts, {} items; uniform {:.1f}{}, guided {:.1f}{} executions; "
                           "asked in {:.0f} ms",
                           uniform.starts, guided.coverable, uniform.runs,
                           uniform.covered ? "" : " (not all)", guided.runs,
                           guided.covered ? "" : " (not all)", guided.prepared_ms)});
  }
  bench.add({"",
             "all",
             {},
             std::nullopt,
             fmt::format("uniform {:.1f}, guided {:.1f} executions, on average over {} seeds",
                         uniform_runs, guided_runs, kSeeds)});
}

}  // namespace parallax::tools
