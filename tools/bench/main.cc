// Speed and memory of the program, beside its peers, measured in one run. See
// docs/internals/performance.md.

#include <fmt/core.h>

#include <algorithm>
#include <fstream>

#include "tools/bench/bench.h"
#include "tools/bench/check.h"
#include "tools/bench/families/families.h"
#include "tools/cli/command_line.h"

namespace parallax::tools {

const std::vector<Section>& sections() {
  static const std::vector<Section> all = {
      {"start", "start of the program", measure_start},
      {"compilation", "compile time, beside clingo's grounder", measure_compilation},
      {"counting", "counting traces, beside clingo", measure_counting},
      {"listing", "listing traces, beside clingo", measure_listing},
      {"first-trace", "the first trace, beside CaDiCaL alone and clingo", measure_first_trace},
      {"first-trace-large", "the same, larger; measured only if it is named",
       measure_large_first_trace, true},
      {"consequences", "what always and what ever holds, beside clingo", measure_consequences},
      {"optimum", "the cheapest trace, beside clingo", measure_optimum},
      {"strategies", "ways to enumerate, side by side", measure_strategies},
      {"proofs", "a checked proof that a list is complete, beside the list alone", measure_proofs},
      {"examples", "the examples of the reasoner of 2005", measure_examples},
      {"difference", "two revisions of a model compared", measure_difference},
      {"horizons", "compile time over the horizon", measure_horizons},
      {"growth", "every stage over items, rooms and steps of a household", measure_growth},
      {"plan", "a long plan in the kitchen", measure_plan},
      {"plan-folder", "a folder of plans of 3,000 lines", measure_plan_folder},
      {"world", "the two-region world", measure_world},
      {"loop", "a plan of the kitchen executed, beside its actions alone", measure_loop},
      {"monitor", "a log of the kitchen held against its model", measure_monitor},
      {"starts", "executions until a plan is covered, uniform and guided", measure_starts},
      {"demo", "the demo", measure_demo},
      {"build", "building the program; measured only if it is named", measure_build, true},
      {"repair", "mistakes put into models; measured only if it is named", measure_repair, true},
      {"rival", "planning beside clingo; measured only if it is named", measure_rival, true},
  };
  return all;
}

namespace {

struct BenchOptions {
  MeasureOptions measure;
  std::vector<std::string> only;
  std::string json;
};

/// 1 if a program gave another answer than its peer; times are figures, not conditions.
int measure_all(const BenchOptions& options) {
  Bench bench(options.measure);
  for (const auto& section : sections()) {
    const bool named = std::count(options.only.begin(), options.only.end(), section.name) != 0;
    const bool wanted = named || (options.only.empty() && !section.only_by_name);
    if (!wanted) continue;
    section.measure(bench);
    bench.sum_up();
  }
  if (!options.json.empty()) std::ofstream(options.json) << to_json(bench.rows());
  const bool agree = std::all_of(bench.rows().begin(), bench.rows().end(),
                                 [](const Row& row) { return row.agrees(); });
  return agree ? 0 : 1;
}

int print_model(const std::string& name, bool tuned) {
  const auto text = tuned ? family_program(name) : family_model(name);
  if (!text) {
    fmt::print(stderr, "no family has a model `{}`\n", name);
    return 2;
  }
  fmt::print("{}", *text);
  return 0;
}

OneOf section_names() {
  OneOf names;
  for (const auto& section : sections()) names.values.emplace_back(section.name);
  return names;
}

std::string list_of_sections() {
  std::string text = "Sections:\n";
  for (const auto& section : sections()) {
    text += fmt::format("  {:<18}{}\n", section.name, section.what);
  }
  return text +
         "Examples:\n  parallax_bench --only counting --json counting.json\n"
         "  parallax_bench model robot_4_2_8 > robot.e\n";
}

int run(int argc, char** argv) {
  OptionTable table("parallax_bench", "Measures the program beside its peers");
  table.footer(list_of_sections());
  BenchOptions options;
  table
      .option("--only", options.only,
              "Sections to measure; default: all but those that say otherwise")
      .check(section_names());
  table.option("--json", options.json, "File for all figures as one JSON document");
  table.option("--repetitions", options.measure.repetitions, "Runs of which the median counts")
      .check(IntRange{1, 1000})
      .show_default();
  table
      .option("--time-limit", options.measure.time_limit_s,
              "Seconds of processor time that a single run may take")
      .check(FiniteNumber{0.1, 1e5})
      .show_default();
  bool checks = false;
  CheckOptions check;
  check.bounds = PARALLAX_SOURCE_DIR "/tools/bench/bounds.json";
  table.flag("--check", checks, "Hold cheap questions against the recorded bounds, in two minutes");
  table.flag("--record", check.record, "With --check: record what was measured as the new bounds");
  table.option("--bounds", check.bounds, "With --check: the file of bounds").show_default();
  table
      .option("--build-cpu", check.build_cpu_s,
              "With --check: processor seconds that a build of all from nothing took")
      .check(FiniteNumber{0.0, 1e6});
  std::string argument;
  bool tuned = false;
  OptionTable model("model", "Print the model of a family, such as lamps_4_6");
  model.flag("--tuned", tuned, "The logic program that a clingo user would write instead");
  OptionTable solve("solve", "CaDiCaL alone on a DIMACS file");
  OptionTable stages("stages", "Time the stages of compiling a model file");
  const Program program{table, "", false, {&model, &solve, &stages}};
  for (auto* command : {&model, &solve, &stages}) {
    command->option("name", argument, "Name or file").required();
  }
  StagesInput staged;
  stages.option("--plan", staged.plan, "A plan that goes with the model, with its --bind");
  stages.option("--bind", staged.binding, "Its binding table");
  const auto line = parse_and_print(program, argc, argv);
  if (line.exit_code) return *line.exit_code;
  if (!line.command) return checks ? check_bounds(check) : measure_all(options);
  const auto* command = program.commands[*line.command];
  if (command == &model) return print_model(argument, tuned);
  if (command == &solve) return solve_plainly(argument);
  staged.model = argument;
  return print_stages(staged);
}

}  // namespace
}  // namespace parallax::tools

int main(int argc, char** argv) { return parallax::tools::run(argc, argv); }
