// parallax_mistake_table: how often `parallax repair` finds the mistake that was put into a model.

#include <fmt/core.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tools/bench/mistakes/mistake_bench.h"
#include "tools/bench/mistakes/mistake_table.h"
#include "tools/cli/command_line.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

std::vector<MistakeOutcome> read_outcomes(const std::string& file) {
  std::vector<MistakeOutcome> out;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (auto outcome = read_outcome(line)) out.push_back(std::move(*outcome));
  }
  return out;
}

OneOf world_names() {
  OneOf names;
  for (const auto& world : mistake_worlds()) names.values.push_back(world.name);
  return names;
}

int run(int argc, char** argv) {
  OptionTable table("parallax_mistake_table", "Measures repairs of models with mistakes");
  table.footer(
      "Examples:\n  parallax_mistake_table --lines mistakes.jsonl --json mistakes.json\n"
      "  parallax_mistake_table --world post --at-most 20 --doubles 0\n");
  MistakeBenchOptions options;
  options.trial.worlds = PARALLAX_SOURCE_DIR "/tools/bench/mistakes/worlds";
  options.trial.program = PARALLAX_BINARY_DIR "/parallax";
  std::string lines, document;
  int at_most = 1000, doubles = 10;
  bool is_told = false;
  table.option("--world", options.worlds, "Worlds to measure; default: all").check(world_names());
  table.option("--program", options.trial.program, "The program under test").show_default();
  table.option("--at-most", at_most, "Single mistakes of a world")
      .check(IntRange{1, 100000})
      .show_default();
  table.option("--doubles", doubles, "Pairs of mistakes of a world")
      .check(IntRange{0, 1000})
      .show_default();
  table.option("--seconds", options.seconds, "Begin nothing more after this time")
      .check(FiniteNumber{0.0, 1e9});
  table.option("--lines", lines, "One JSON line a mistake; those that it has are not done again");
  table.option("--json", document, "File for the counts as one JSON document");
  table.flag("--told", is_told, "Print the table of --lines and measure nothing");
  const Program program{table, "", false, {}};
  const auto parsed = parse_and_print(program, argc, argv);
  if (parsed.exit_code) return *parsed.exit_code;
  options.at_most = static_cast<std::size_t>(at_most);
  options.doubles = static_cast<std::size_t>(doubles);
  options.trial.program = fs::absolute(options.trial.program).string();
  const auto folder = fs::temp_directory_path() / fmt::format("parallax_mistakes_{}", ::getpid());
  options.trial.folder = folder.string();
  auto outcomes = lines.empty() ? std::vector<MistakeOutcome>() : read_outcomes(lines);
  std::string error;
  if (!is_told) {
    std::ofstream out;
    if (!lines.empty()) out.open(lines, std::ios::app);
    outcomes = measure_mistakes(
        options, outcomes,
        [&](const MistakeOutcome& outcome) {
          if (out.is_open()) out << to_json(outcome) << std::endl;
        },
        error);
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
  if (!error.empty()) {
    fmt::print(stderr, "{}\n", error);
    return 3;
  }
  const auto counts = count_mistakes(outcomes);
  fmt::print("{}", to_markdown(counts));
  if (!document.empty()) std::ofstream(document) << to_json(counts);
  return 0;
}

}  // namespace
}  // namespace parallax::tools

int main(int argc, char** argv) { return parallax::tools::run(argc, argv); }
