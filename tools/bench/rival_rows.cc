// Planning questions beside clingo: the first trace of unknown length, and that there is none
// shorter.

#include <fmt/core.h>

#include <array>
#include <fstream>

#include "tools/bench/bench.h"
#include "tools/bench/child_run.h"
#include "tools/bench/contestants.h"
#include "tools/bench/families/families.h"

namespace parallax::tools {
namespace {

constexpr std::array kRivalConfigurations = {"auto", "handy", "trendy"};

/// A task whose shortest trace has so many steps.
struct RivalTask {
  const char* name;  // of the family and its sizes, without a horizon
  int shortest = 0;
};

/// Each family on a ladder of sizes.
constexpr std::array kRivalTasks = {
    RivalTask{"hanoi_3", 7},         RivalTask{"hanoi_4", 15},
    RivalTask{"hanoi_5", 31},        RivalTask{"hanoi_6", 63},
    RivalTask{"logistics_3_2_4", 6}, RivalTask{"logistics_5_2_4", 9},
    RivalTask{"logistics_6_3_6", 7}, RivalTask{"grid_4_4", 6},
    RivalTask{"grid_6_5", 10},       RivalTask{"grid_5_8", 8},
    RivalTask{"grid_8_8", 14}};

std::string verdict_of(const ChildRun& run) {
  if (run.tail.starts_with("holds") && run.tail.find("(proof checked)") != std::string::npos) {
    return "unsatisfiable";
  }
  return run.tail.starts_with("violated") ? "satisfiable" : "";
}

Contestant clingo_of_length(const std::string& program, int length, const char* configuration) {
  auto clingo = clingo_finds(program, configuration);
  clingo.command.insert(clingo.command.end(), {"-c", fmt::format("horizon={}", length)});
  return clingo;
}

/// One call for each length up to the shortest trace's.
Contestant clingo_of_each_length(const std::string& program, int shortest,
                                 const char* configuration) {
  auto clingo = clingo_finds(program, configuration);
  clingo.program = fmt::format("clingo, {}, each length", configuration);
  clingo.command = {"sh", "-c",
                    fmt::format("for n in $(seq 1 {}); do clingo {} -q --warn=none "
                                "--configuration={} -c horizon=$n; done",
                                shortest, program, configuration)};
  return clingo;
}

void compare_rival(Bench& bench, const RivalTask& rival) {
  const auto name = fmt::format("{}_{}", rival.name, rival.shortest);
  const auto task = family_task(name).value();
  const auto world = bench.path(name + ".world.e");
  std::ofstream(world) << task.world;
  const auto program = bench.program_file(name, Encoding::kTuned);

  // Ours is told no more than that twice as many steps would do.
  auto first =
      parallax_with({"traces", world, "--until", task.goal, "--horizon",
                     std::to_string(2 * rival.shortest), "--limit", "1", "--format", "jsonl"});
  first.answer = [](const ChildRun& run) {
    return jsonl_answer(run.tail) == "1" ? "satisfiable" : "unsatisfiable";
  };
  std::vector<Contestant> contestants = {first};
  for (const auto* configuration : kRivalConfigurations) {
    contestants.push_back(clingo_of_length(program, rival.shortest, configuration));
  }
  for (const auto* configuration : kRivalConfigurations) {
    contestants.push_back(clingo_of_each_length(program, rival.shortest, configuration));
  }
  bench.compare(fmt::format("{}, first trace", rival.name), contestants, "satisfiable");

  auto none = parallax_with({"verify", world, "--property", "!(" + task.goal + ")", "--horizon",
                             std::to_string(rival.shortest - 1)});
  none.answer = verdict_of;
  contestants = {none};
  for (const auto* configuration : kRivalConfigurations) {
    contestants.push_back(clingo_of_length(program, rival.shortest - 1, configuration));
  }
  bench.compare(fmt::format("{}, none shorter", rival.name), contestants, "unsatisfiable");
}

}  // namespace

void measure_rival(Bench& bench) {
  bench.begin("planning beside clingo: first trace of unknown length, proof that none is shorter");
  for (const auto& rival : kRivalTasks) compare_rival(bench, rival);
  bench.sum_up();
}

}  // namespace parallax::tools
