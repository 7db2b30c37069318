// The first trace, beside the solver alone on the same clauses; ways to enumerate, side by side.

#include <fmt/core.h>

#include <array>
#include <fstream>
#include <tuple>
#include <utility>
#include <vector>

#include "tools/bench/bench.h"
#include "tools/bench/child_run.h"
#include "tools/bench/contestants.h"
#include "tools/bench/families/families.h"

namespace parallax::tools {
namespace {

/// The sets of options of clingo's own that do best on planning problems.
constexpr std::array kConfigurations = {"auto", "handy", "trendy"};

/// The first `limit` traces (0: all), found in one of the ways that `--strategy` names.
Contestant lists_by(const char* strategy, const std::string& file, int limit) {
  auto contestant = parallax_with({"traces", file, "--strategy", strategy, "--limit",
                                   std::to_string(limit), "--format", "jsonl"});
  contestant.program = strategy;
  contestant.answer = [](const ChildRun& run) { return jsonl_answer(run.tail); };
  return contestant;
}

}  // namespace

namespace {

Contestant finds_first(const std::string& file, const std::string& order) {
  auto ours =
      parallax_with({"traces", file, "--limit", "1", "--format", "jsonl", "--order", order});
  ours.program = "--order " + order;
  ours.answer = [](const ChildRun& run) {
    return jsonl_answer(run.tail) == "1" ? "satisfiable" : "unsatisfiable";
  };
  return ours;
}

void compare_first(Bench& bench, const std::string& name) {
  const auto file = bench.artifact_file(name);
  Contestant plain{"cadical", {bench_program(), "solve", file}, "", {10, 20}, {}};
  plain.answer = [](const ChildRun& run) {
    return run.code == 10 ? "satisfiable" : "unsatisfiable";
  };
  std::vector<Contestant> contestants = {finds_first(file, "any"), finds_first(file, "canonical"),
                                         plain};
  if (family_program(name)) {
    for (const auto* configuration : kConfigurations) {
      contestants.push_back(
          clingo_finds(bench.program_file(name, Encoding::kTuned), configuration));
    }
  }
  bench.compare(name, contestants);
}

}  // namespace

void measure_first_trace(Bench& bench) {
  bench.begin("first trace of an artifact, beside CaDiCaL alone on the same file, and clingo");
  for (const auto* name : {"falling_40", "bankproj_8_400_10_60", "lamps_20_50", "robot_6_3_0",
                           "robot_6_4_2", "robot_8_4_0", "robot_7_5_m1", "robot_9_5_0"}) {
    compare_first(bench, name);
  }
}

void measure_large_first_trace(Bench& bench) {
  bench.begin("first trace, larger, beside CaDiCaL alone and clingo");
  for (const auto* name : {"robot_10_4_0", "robot_12_4_0", "robot_8_5_m1", "robot_9_5_m1",
                           "robot_10_5_0", "robot_9_6_0"}) {
    compare_first(bench, name);
  }
}

void measure_consequences(Bench& bench) {
  bench.begin("what all traces share, and what some have, beside clingo");
  const auto ours = [](const std::string& file, const std::vector<std::string>& extents) {
    auto contestant = parallax_with({"consequences", file, "--json"});
    if (extents.size() == 1) contestant.command.emplace_back("--always");
    contestant.answer = [extents](const ChildRun& run) {
      return consequences_answer(run.tail, extents);
    };
    return contestant;
  };
  for (const auto* name : {"robot_4_2_4", "robot_6_4_2", "bankproj_4_100_5_20", "bankplan_3_12_4_5",
                           "lamps_20_50", "falling_40"}) {
    const auto file = bench.model_file(name);
    const auto program = bench.program_without(name, "#show released_at/2.");
    for (const auto& [what, mode, extents] :
         {std::tuple("all", "cautious", std::vector<std::string>{"always"}),
          std::tuple("some", "brave", std::vector<std::string>{"always", "sometimes"})}) {
      std::vector<Contestant> contestants = {ours(file, extents)};
      for (const auto* configuration : kConfigurations) {
        contestants.push_back(clingo_consequences(program, mode, configuration));
      }
      bench.compare(fmt::format("{}, {}", name, what), contestants);
    }
  }
}

void measure_optimum(Bench& bench) {
  bench.begin("the optimum, beside clingo on a program written by hand");
  const auto costs = bench.path("costs.lp");
  std::ofstream(costs) << "#minimize { R,e,T : happens(enter(R),T); 2,g,X,T : happens(grasp(X),T); "
                          "1,d,X,T : happens(drop(X),T) }.\n";
  for (const auto* name : {"robot_6_4_0", "robot_6_4_2", "robot_6_4_4"}) {
    auto ours = parallax_with(
        {"traces", bench.model_file(name), "--limit", "1", "--format", "jsonl", "--minimize",
         "sum room: Happens(Enter(room),time), "
         "sum 2: Happens(Grasp(thing),time), count Happens(Drop(thing),time)"});
    ours.answer = [](const ChildRun& run) { return optimum_answer(run.tail); };
    std::vector<Contestant> contestants = {ours};
    for (const auto* configuration : kConfigurations) {
      contestants.push_back(
          clingo_minimizes(bench.program_file(name, Encoding::kTuned), costs, configuration));
    }
    bench.compare(name, contestants);
  }
}

void measure_strategies(Bench& bench) {
  bench.begin("ways to enumerate, where a clause ties far timepoints together");
  for (const int limit : {5'000, 50'000}) {
    const auto file = bench.model_file("distant_4_6");
    bench.compare(fmt::format("distant_4_6, {} traces", limit),
                  {lists_by("search", file, limit), lists_by("tree", file, limit),
                   lists_by("guarded", file, limit), lists_by("blocking", file, limit)},
                  std::to_string(limit));
  }
  bench.begin("ways to enumerate, where the trace graph applies");
  const auto file = bench.model_file("robot_4_2_4");
  bench.compare("robot_4_2_4",
                {lists_by("graph", file, 0), lists_by("search", file, 0), lists_by("tree", file, 0),
                 lists_by("guarded", file, 0), lists_by("blocking", file, 0)},
                "3488");
}

void measure_proofs(Bench& bench) {
  bench.begin("all traces with a checked proof that there are no others, beside the list alone");
  for (const auto& [name, traces] : {std::pair("pigeon_9_8", "0"), std::pair("robot_6_4_m1", "0"),
                                     std::pair("robot_4_2_4", "3488")}) {
    const auto file = bench.model_file(name);
    auto certified = parallax_with({"traces", file, "--limit", "0", "--format", "jsonl",
                                    "--certify=" + bench.path(std::string(name) + ".drat")});
    certified.program = "--certify";
    certified.answer = [](const ChildRun& run) { return jsonl_answer(run.tail); };
    bench.compare(name, {certified, parallax_lists(file)}, traces);
  }
}

}  // namespace parallax::tools
