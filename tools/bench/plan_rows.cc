// A plan of more than 150 lines with the kitchen model: how its clauses grow with the horizon, and
// the time to them, to the first trace and to each further one.

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>

#include "compiler/base/file_io.h"
#include "compiler/pipeline/compile.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "tools/bench/bench.h"

namespace parallax::tools {
namespace {

constexpr int kHorizons[] = {10, 20, 30, 40, 50};

/// Where the kitchen's plans point: bases for `region`, cells of counter and table elsewhere.
class KitchenPlaces final : public compiler::PoseLocator {
 public:
  std::optional<std::string> region_of(std::string_view function,
                                       const compiler::Pose& pose) const override {
    const bool counter = pose.x_m > 0.3;
    if (function == "region") return counter ? "bWork" : "bTable";
    const int cell = static_cast<int>((pose.y_m - (counter ? 0.0 : 0.40)) / 0.15) + 1;
    return (counter ? "pw" : "pt") + std::to_string(std::clamp(cell, 1, counter ? 3 : 4));
  }
  std::optional<Nearest> nearest(std::string_view, const compiler::Pose&) const override {
    return std::nullopt;
  }
};

std::optional<compiler::Compilation> compile(int horizon, bool with_plan) {
  namespace fs = std::filesystem;
  const fs::path root = PARALLAX_SOURCE_DIR;
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const KitchenPlaces places;
  compiler::CompileInput input;
  input.models = {root / "scenarios/kitchen/domain.e", root / "tests/plans/start_untidy.e"};
  input.load.allow_outside = true;
  input.horizon = horizon;
  if (with_plan) {
    const auto plan = base::load_text(root / "tests/plans/lay_the_table.lisp", files, sink);
    const auto bind = base::load_text(root / "scenarios/kitchen/robot.bind", files, sink);
    if (!plan || !bind) return std::nullopt;
    input.plan = compiler::PlanInput{{*plan}, *bind, std::nullopt, &places};
  }
  const std::string goal = "{base} (Happens(Go(base),time-1) & HoldsAt(RobotAt(base),time))";
  const auto text = files.add("goal", goal);
  const base::SourceRange range{text, 0, static_cast<std::uint32_t>(goal.size())};
  input.constraints = {{range, range}};
  auto compilation = compiler::compile_model(input, files, sink);
  if (!compilation) return std::nullopt;
  return *std::move(compilation);
}

void add_figure(Bench& bench, std::string name, std::string note) {
  Row row;
  row.name = std::move(name);
  row.note = std::move(note);
  bench.add(std::move(row));
}

void measure_traces(Bench& bench, const compiler::CompiledModel& model) {
  Stopwatch loading;
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  runtime::PlanEnumerator enumerator(session);
  const auto first = enumerator.next();
  add_figure(bench, "first trace",
             fmt::format("{:.0f} ms behind the clauses, {}", loading.lap_ms(),
                         first ? fmt::format("{} events", first->length()) : "there is none"));
  double worst = 0.0;
  double sum = 0.0;
  for (int further = 0;; ++further) {
    Stopwatch watch;
    const auto trace = enumerator.next();
    const double ms = watch.lap_ms();
    if (!trace) {
      add_figure(bench, "further traces",
                 fmt::format("{}, {:.0f} ms each, {:.0f} ms at most", further,
                             sum / std::max(1, further), worst));
      add_figure(bench, "no others", fmt::format("{:.0f} ms to prove it", ms));
      return;
    }
    sum += ms;
    worst = std::max(worst, ms);
  }
}

}  // namespace

void measure_plan(Bench& bench) {
  bench.begin("a plan of 155 lines in the kitchen, processor time");
  std::optional<compiler::Compilation> longest;
  for (const int horizon : kHorizons) {
    Stopwatch watch;
    auto compilation = compile(horizon, true);
    const double ms = watch.lap_ms();
    const auto alone = compile(horizon, false);
    if (!compilation || !alone) return add_figure(bench, "compilation", "the kitchen is missing");
    add_figure(bench, fmt::format("horizon {}", horizon),
               fmt::format("{} clauses ({} without the plan), {} variables, compiled in {:.0f} ms",
                           compilation->model.clauses.size(), alone->model.clauses.size(),
                           compilation->model.variable_count(), ms));
    longest = std::move(compilation);
  }
  measure_traces(bench, longest->model);
}

}  // namespace parallax::tools
