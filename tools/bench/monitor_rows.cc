// A log of the kitchen checked against its model: one simulated run, each state observed many times
// with noise in every coordinate.

#include <fcntl.h>
#include <fmt/core.h>

#include <cmath>
#include <fstream>
#include <set>

#include "compiler/base/descriptor.h"
#include "compiler/base/json.h"
#include "harness/campaign/sample_runner.h"
#include "harness/robot/ode_simulator.h"
#include "harness/simulator/state_json.h"
#include "tools/app/monitor.h"
#include "tools/app/trace_feed.h"
#include "tools/bench/bench.h"

namespace parallax::tools {
namespace {

constexpr const char* kWatched = PARALLAX_SOURCE_DIR "/scenarios/kitchen/plan2_modified.yaml";
/// Observations of each state; with 10 to 20 states some ten thousand in all.
constexpr int kSeenTimes = 2000;
constexpr double kNoise = 1e-6;  // [m, rad] far less than anything is from a border

/// The middle of the states that the first trace starts in.
harness::State middle_start(const ScenarioModel& loaded, const harness::CampaignTrace& trace,
                            Context& context) {
  const harness::ModelFluents fluents(*trace.symbols);
  const auto holds = trace.holds(0);
  const auto cuboid = loaded.scenario.mapping->start_cuboid(
      fluents.ground(), std::set<std::string>(holds.begin(), holds.end()), loaded.scenario.sampling,
      loaded.scenario.sampling_source, context.sink());
  harness::State start;
  for (const auto& dimension : cuboid->dimensions) {
    start.emplace(dimension.variable, dimension.interval.midpoint());
  }
  return start;
}

class LogFile {
 public:
  explicit LogFile(const std::string& path) : out_(path) {}

  void event(const std::string& name) {
    out_ << fmt::format("{{\"t\": {:.3f}, \"event\": {}}}\n", t_ += 0.001, base::json_quoted(name));
  }
  void states(const harness::State& state) {
    for (int i = 0; i < kSeenTimes; ++i) {
      auto seen = state;
      for (auto& [name, value] : seen) {
        if (name.ends_with(".q")) continue;  // a drawer that is shut is at its stop
        if (auto* real = std::get_if<double>(&value)) *real += kNoise * std::sin(++count_);
      }
      out_ << fmt::format("{{\"t\": {:.3f}, \"state\": {}}}\n", t_ += 0.001,
                          base::json_text(harness::state_json<nlohmann::ordered_json>(seen)));
    }
  }

 private:
  std::ofstream out_;
  double t_ = 0.0, count_ = 0.0;
};

void write_log(const ScenarioModel& loaded, const std::string& path, Context& context) {
  EnumeratedTraces traces(loaded.compilation.model, context);
  const auto trace = **traces.next();
  const auto calls = *harness::action_calls(loaded.scenario, trace, context.sink());
  harness::OdeSimulator simulator(loaded.scenario.world);
  simulator.reset(middle_start(loaded, trace, context), 1);
  LogFile log(path);
  log.states(simulator.observe());
  for (std::size_t i = 0; i < calls.size(); ++i) {
    simulator.act(calls[i].controller, calls[i].arguments, calls[i].time_limit_s);
    log.event(trace.event(i));
    log.states(simulator.observe());
  }
}

}  // namespace

void measure_monitor(Bench& bench) {
  bench.begin("a log of the kitchen held against its model and plan");
  Context context;
  const auto loaded = load_scenario_model(kWatched, context, {.watched = true});
  const auto path = bench.path("kitchen.jsonl");
  write_log(*loaded, path, context);
  for (const bool with_plan : {true, false}) {
    WatchOptions options;
    options.with_plan = with_plan;
    Stopwatch preparing;
    const auto watch = Watch::make(*loaded, options, context);
    const double prepared_ms = preparing.lap_ms();
    const char* name = with_plan ? "model and plan" : "model alone";
    if (!watch) {
      bench.add({"", name, {}, std::nullopt, "the model cannot be followed"});
      continue;
    }
    const base::Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    Stopwatch watching;
    const auto result = monitor_log(**watch, file.get(), path, context, {});
    const double seconds = 1e-3 * watching.lap_ms();
    bench.add(
        {"",
         name,
         {},
         std::nullopt,
         fmt::format("{}: {} observations of {} variables, {} steps: {:.0f} observations/s of "
                     "processor time; prepared in {:.0f} ms, at most {} states",
                     to_string(result.verdict), result.observations,
                     (*watch)->reader().variables().size(), result.events,
                     static_cast<double>(result.observations) / seconds, prepared_ms,
                     result.most_states)});
  }
}

}  // namespace parallax::tools
