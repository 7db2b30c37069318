// Speed and memory of the program, beside its peers, measured in one run. See docs/performance.md.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>

#include "tools/bench/bench.h"
#include "tools/bench/families/families.h"
#include "tools/bench/plain_cadical.h"
#include "tools/bench/stages.h"

namespace parallax::tools {

const std::vector<Section>& sections() {
  static const std::vector<Section> all = {
      {"start", "start of the program", measure_start},
      {"compilation", "compile time, beside clingo's grounder", measure_compilation},
      {"counting", "counting traces, beside clingo", measure_counting},
      {"listing", "listing traces, beside clingo", measure_listing},
      {"first-trace", "the first trace, beside CaDiCaL alone", measure_first_trace},
      {"strategies", "ways to enumerate, side by side", measure_strategies},
      {"proofs", "a checked proof that a list is complete, beside the list alone", measure_proofs},
      {"examples", "the examples of the reasoner of 2005", measure_examples},
      {"difference", "two revisions of a model compared", measure_difference},
      {"horizons", "compile time over the horizon", measure_horizons},
      {"plan", "a long plan in the kitchen", measure_plan},
      {"world", "the two-region world", measure_world},
      {"demo", "the demo", measure_demo},
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
    const bool wanted = options.only.empty() ||
                        std::count(options.only.begin(), options.only.end(), section.name) != 0;
    if (wanted) section.measure(bench);
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

CLI::Validator section_names() {
  std::vector<std::string> names;
  for (const auto& section : sections()) names.emplace_back(section.name);
  return CLI::IsMember(names);
}

std::string list_of_sections() {
  std::string text = "Sections:\n";
  for (const auto& section : sections()) {
    text += fmt::format("  {:<14}{}\n", section.name, section.what);
  }
  return text +
         "Examples:\n  parallax_bench --only counting --json counting.json\n"
         "  parallax_bench model robot_4_2_8 > robot.e\n";
}

int run(int argc, char** argv) {
  CLI::App app("Measures the program beside its peers", "parallax_bench");
  app.footer(list_of_sections());
  BenchOptions options;
  app.add_option("--only", options.only, "Sections to measure; default: all")
      ->check(section_names());
  app.add_option("--json", options.json, "File for all figures as one JSON document");
  app.add_option("--repetitions", options.measure.repetitions, "Runs of which the median counts")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--time-limit", options.measure.time_limit_s,
                 "Seconds of processor time that a single run may take")
      ->check(CLI::Range(0.1, 1e5))
      ->capture_default_str();
  std::string argument;
  auto* model = app.add_subcommand("model", "Print the model of a family, such as lamps_4_6");
  bool tuned = false;
  model->add_flag("--tuned", tuned, "The logic program that a clingo user would write instead");
  auto* solve = app.add_subcommand("solve", "CaDiCaL alone on a DIMACS file");
  auto* stages = app.add_subcommand("stages", "Time the stages of compiling a model file");
  for (auto* command : {model, solve, stages}) {
    command->add_option("name", argument, "Name or file")->required();
  }
  CLI11_PARSE(app, argc, argv);
  if (model->parsed()) return print_model(argument, tuned);
  if (solve->parsed()) return solve_plainly(argument);
  if (stages->parsed()) return print_stages(argument);
  return measure_all(options);
}

}  // namespace
}  // namespace parallax::tools

int main(int argc, char** argv) { return parallax::tools::run(argc, argv); }
