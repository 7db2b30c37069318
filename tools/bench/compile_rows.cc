// Reading a model and making clauses of it, beside clingo's grounder on the exported program.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "compiler/artifact/artifact_writer.h"
#include "compiler/base/file_io.h"
#include "compiler/ground/grounder.h"
#include "compiler/pipeline/compile.h"
#include "compiler/sema/check.h"
#include "compiler/syntax/loader.h"
#include "tools/bench/bench.h"
#include "tools/bench/contestants.h"

namespace parallax::tools {
namespace {

/// The last horizon at which clingo's grounder takes part: beyond it needs gigabytes.
constexpr int kLastGroundedHorizon = 10'000;

/// `robot_4_2_SLACK` has this horizon and goes on for `slack` steps.
constexpr int kShortestPlan = 10;

Contestant grounding(Bench& bench, const std::string& name, Encoding encoding) {
  return clingo_grounds(bench.program_file(name, encoding), encoding);
}

}  // namespace

int print_stages(const StagesInput& staged) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  Stopwatch watch;
  const std::vector<std::filesystem::path> paths = {staged.model};
  const auto ast = compiler::load_model(paths, {}, files, sink);
  if (!ast) return 3;
  const auto typed = compiler::check_model(*ast, files, sink);
  if (!typed) return 3;
  const double read_ms = watch.lap_ms();
  if (!compiler::ground_model(*typed, {}, sink)) return 3;
  const double ground_ms = watch.lap_ms();
  compiler::CompileInput input;
  input.models = paths;
  input.folded = true;
  if (!staged.plan.empty()) {
    const auto plan = base::load_text(staged.plan, files, sink);
    const auto bind = base::load_text(staged.binding, files, sink);
    if (!plan || !bind) return 3;
    input.plan = compiler::PlanInput{{*plan}, *bind};
  }
  const auto compiled = compiler::compile_model(input, files, sink);
  if (!compiled) return 3;
  const double compile_ms = watch.lap_ms();
  std::size_t bytes = 0;
  watch.lap_ms();
  compiler::write_artifact(compiled->model, {},
                           [&](std::string_view piece) { bytes += piece.size(); });
  fmt::print(
      "read {:.1f} ms, ground {:.1f} ms, clauses {:.1f} ms, text {:.1f} ms; {} clauses, {:.1f} "
      "MB\n",
      read_ms, ground_ms, std::max(0.0, compile_ms - read_ms - ground_ms), watch.lap_ms(),
      compiled->model.clause_count(), 1e-6 * static_cast<double>(bytes));
  return 0;
}

void measure_start(Bench& bench) {
  bench.begin("start of the program");
  Contestant clingo{"clingo", {"clingo", "--version"}, "", {0}, {}};
  bench.compare("--version", {parallax_with({"--version"}), clingo});
}

void measure_compilation(Bench& bench) {
  const std::vector<std::pair<std::string, std::string>> models = {{"falling_40", "1"},
                                                                   {"chain_200", "0"},
                                                                   {"bankproj_4_100_5_20", "1"},
                                                                   {"bankproj_8_400_10_60", "1"}};
  bench.begin("compilation, beside clingo's grounding");
  for (const auto& [name, traces] : models) {
    bench.compare(
        name,
        {parallax_with({"compile", bench.model_file(name), "-o", bench.path(name + ".dec.cnf")}),
         grounding(bench, name, Encoding::kExported), grounding(bench, name, Encoding::kTuned)});
  }
  bench.begin("compilation and all traces, listed");
  for (const auto& [name, traces] : models) {
    const auto clingo = [&, &file = name](Encoding encoding) {
      return clingo_lists(bench.program_file(file, encoding), encoding);
    };
    bench.compare(name,
                  {parallax_lists(bench.model_file(name)), clingo(Encoding::kExported),
                   clingo(Encoding::kTuned)},
                  traces);
  }
}

void measure_horizons(Bench& bench) {
  bench.begin("compile time over the horizon (robot_4_2)");
  for (int horizon = 10; horizon <= 100'000; horizon *= 10) {
    const auto name = fmt::format("robot_4_2_{}", horizon - kShortestPlan);
    const auto artifact = bench.path(name + ".dec.cnf");
    std::vector<Contestant> contestants = {
        parallax_with({"compile", bench.model_file(name), "-o", artifact})};
    if (horizon <= kLastGroundedHorizon) {
      contestants.push_back(grounding(bench, name, Encoding::kExported));
      contestants.push_back(grounding(bench, name, Encoding::kTuned));
    }
    bench.compare(fmt::format("horizon {}", horizon), contestants);

    // The stages, timed inside one process; its last line is the answer.
    const auto stages = run_child({bench_program(), "stages", bench.model_file(name)},
                                  {bench.path("output"), "", 600.0});
    Row row;
    row.name = fmt::format("horizon {}, stages", horizon);
    row.note = stages && stages->code == 0 ? stages->tail : "could not be measured";
    while (row.note.ends_with('\n')) row.note.pop_back();
    bench.add(std::move(row));
    std::error_code ignored;
    std::filesystem::remove(artifact, ignored);
  }
}

}  // namespace parallax::tools
