// A plan of more than 150 lines with the kitchen model: how its clauses grow with the horizon, and
// the time to them, to the first trace and to each further one. The same for a folder of plans of
// 3,000 lines.

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/file_io.h"
#include "compiler/pipeline/compile.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "tools/bench/bench.h"
#include "tools/bench/families/plan_folder.h"

namespace parallax::tools {
namespace {

constexpr int kHorizons[] = {10, 20, 30, 40, 50};

/// Places in the kitchen's plans: bases for `region`, cells of counter and table elsewhere.
class KitchenPlaces final : public compiler::PoseLocator {
 public:
  std::optional<std::string> region_of(std::string_view function,
                                       const compiler::PlanPose& pose) const override {
    const bool counter = pose.x_m > 0.3;
    if (function == "region") return counter ? "bWork" : "bTable";
    const int cell = static_cast<int>((pose.y_m - (counter ? 0.0 : 0.40)) / 0.15) + 1;
    return (counter ? "pw" : "pt") + std::to_string(std::clamp(cell, 1, counter ? 3 : 4));
  }
  std::optional<Nearest> nearest(std::string_view, const compiler::PlanPose&) const override {
    return std::nullopt;
  }
};

namespace fs = std::filesystem;

/// The files of a plan in the order in which they are loaded.
using PlanTexts = std::vector<std::pair<std::string, std::string>>;

std::optional<compiler::Compilation> compile(int horizon, const PlanTexts& plan) {
  const fs::path root = PARALLAX_SOURCE_DIR;
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const KitchenPlaces places;
  compiler::CompileInput input;
  input.models = {root / "scenarios/kitchen/domain.e", root / "tests/plans/start_untidy.e"};
  input.load.allow_outside = true;
  input.horizon = horizon;
  if (!plan.empty()) {
    const auto bind = base::load_text(root / "scenarios/kitchen/robot.bind", files, sink);
    if (!bind) return std::nullopt;
    std::vector<base::FileId> texts;
    for (const auto& [name, text] : plan) texts.push_back(files.add(name, text));
    input.plan = compiler::PlanInput{std::move(texts), *bind, std::nullopt, &places};
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
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const fs::path root = PARALLAX_SOURCE_DIR;
  const auto file = base::load_text(root / "tests/plans/lay_the_table.lisp", files, sink);
  if (!file) return add_figure(bench, "compilation", "the kitchen is missing");
  const PlanTexts plan = {{files[*file].name(), std::string(files[*file].text())}};
  std::optional<compiler::Compilation> longest;
  for (const int horizon : kHorizons) {
    Stopwatch watch;
    auto compilation = compile(horizon, plan);
    const double ms = watch.lap_ms();
    const auto alone = compile(horizon, {});
    if (!compilation || !alone) return add_figure(bench, "compilation", "the kitchen is missing");
    add_figure(bench, fmt::format("horizon {}", horizon),
               fmt::format("{} clauses ({} without the plan), {} variables, compiled in {:.0f} ms",
                           compilation->model.clauses.size(), alone->model.clauses.size(),
                           compilation->model.variable_count(), ms));
    longest = std::move(compilation);
  }
  measure_traces(bench, longest->model);
}

void measure_plan_folder(Bench& bench) {
  bench.begin("a folder of plans in the kitchen, 31 stations, processor time");
  constexpr int kStations = 31;
  constexpr int kHorizon = 60;
  auto folder = plan_folder(kStations);
  const fs::path place = bench.path("plan-folder");
  fs::create_directories(place);
  PlanTexts plan = {{"package.lisp", folder["package.lisp"]},
                    {"common.lisp", folder["common.lisp"]}};
  for (int i = 1; i <= kStations; ++i) {
    const auto name = fmt::format("station-{}.lisp", i);
    plan.emplace_back(name, folder[name]);
  }
  plan.emplace_back("main.lisp", folder["main.lisp"]);
  std::ptrdiff_t lines = 0;
  for (const auto& [name, text] : folder) {
    std::ofstream(place / name) << text;
    if (name.ends_with(".lisp")) lines += std::count(text.begin(), text.end(), '\n');
  }
  add_figure(bench, "text", fmt::format("{} lines in {} files", lines, plan.size()));
  const fs::path root = PARALLAX_SOURCE_DIR;
  bench.compare(
      "read, checked, unrolled and compiled to horizon 60",
      {parallax_with({"compile", (root / "scenarios/kitchen/domain.e").string(),
                      (root / "tests/plans/start_untidy.e").string(), "--plan", place.string(),
                      "--bind", (root / "scenarios/kitchen/robot.bind").string(), "--regions",
                      (root / "scenarios/kitchen/plan2.yaml").string(), "--horizon",
                      std::to_string(kHorizon), "-o", bench.path("folder.dec.cnf")})});
  const auto compilation = compile(kHorizon, plan);
  if (!compilation) return add_figure(bench, "compilation", "the plan is refused");
  measure_traces(bench, compilation->model);
}

}  // namespace parallax::tools
