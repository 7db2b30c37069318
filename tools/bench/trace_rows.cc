// Counting and listing the traces of the families, beside clingo on the exported program.

#include "tools/bench/bench.h"
#include "tools/bench/contestants.h"

namespace parallax::tools {
namespace {

struct Known {
  const char* name;
  const char* traces;
};

}  // namespace

void measure_counting(Bench& bench) {
  bench.begin("counting all traces");
  for (const auto& [name, traces] : {Known{"robot_4_2_4", "3488"},
                                     {"robot_4_2_8", "1759222"},
                                     {"lamps_4_6", "1048576"},
                                     {"bankplan_3_12_4_5", "10720"}}) {
    bench.compare(
        name, {parallax_counts(bench.model_file(name)), clingo_counts(bench.program_file(name))},
        traces);
  }
  bench.begin("counting more than can be listed");
  bench.compare("robot_6_4_2, 30 steps", {parallax_counts(bench.model_file("robot_6_4_2")),
                                          clingo_counts(bench.program_file("robot_6_4_2"))});
  bench.begin("deciding that there is no trace");
  for (const auto* name : {"robot_6_4_m1", "pigeon_9_8"}) {
    bench.compare(
        name, {parallax_counts(bench.model_file(name)), clingo_counts(bench.program_file(name))},
        "0");
  }
}

void measure_listing(Bench& bench) {
  bench.begin("listing all traces to a file");
  for (const auto& [name, traces] :
       {Known{"robot_4_2_4", "3488"}, {"lamps_4_6", "1048576"}, {"robot_4_2_8", "1759222"}}) {
    bench.compare(name,
                  {parallax_lists(bench.model_file(name)), clingo_lists(bench.program_file(name))},
                  traces);
  }
}

}  // namespace parallax::tools
