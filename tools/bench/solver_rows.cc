// The first trace, beside the solver alone on the same clauses; ways to enumerate, side by side.

#include <fmt/core.h>

#include "tools/bench/answers.h"
#include "tools/bench/bench.h"
#include "tools/bench/contestants.h"

namespace parallax::tools {

void measure_first_trace(Bench& bench) {
  bench.begin("first trace of an artifact, beside CaDiCaL alone on the same file");
  for (const auto* name : {"falling_40", "bankproj_8_400_10_60", "lamps_20_50", "robot_6_3_0",
                           "robot_6_4_2", "robot_8_4_0"}) {
    const auto file = bench.artifact_file(name);
    auto ours = parallax_with({"traces", file, "--limit", "1", "--format", "jsonl"});
    ours.answer = [](const ChildRun& run) {
      return jsonl_answer(run.tail) == "1" ? "satisfiable" : "unsatisfiable";
    };
    Contestant plain{"cadical", {bench_program(), "solve", file}, "", {10, 20}, {}};
    plain.answer = [](const ChildRun& run) {
      return run.code == 10 ? "satisfiable" : "unsatisfiable";
    };
    bench.compare(name, {ours, plain});
  }
}

}  // namespace parallax::tools
