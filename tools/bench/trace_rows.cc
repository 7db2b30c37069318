// Counting and listing the traces of the families, beside clingo.

#include <string>
#include <utility>
#include <vector>

#include "tools/bench/bench.h"
#include "tools/bench/contestants.h"

namespace parallax::tools {
namespace {

struct Known {
  const char* name;
  const char* traces;
};

void compare_counts(Bench& bench, const Known& known) {
  const auto clingo = [&](Encoding encoding) {
    return clingo_counts(bench.program_file(known.name, encoding), encoding);
  };
  bench.compare(known.name,
                {parallax_counts(bench.model_file(known.name)), clingo(Encoding::kExported),
                 clingo(Encoding::kTuned)},
                known.traces);
}

/// Beside what clingo's configurations make of the program by hand.
void compare_configurations(Bench& bench, const Known& known) {
  std::vector<Contestant> all = {parallax_counts(bench.model_file(known.name))};
  for (const std::string name : {"auto", "handy", "trendy", "many"}) {
    auto clingo = clingo_counts(bench.program_file(known.name, Encoding::kTuned), Encoding::kTuned);
    clingo.program = "clingo, " + name;
    clingo.command.push_back("--configuration=" + name);
    all.push_back(std::move(clingo));
  }
  bench.compare(known.name, std::move(all), known.traces);
}

void compare_lists(Bench& bench, const Known& known) {
  const auto clingo = [&](Encoding encoding) {
    return clingo_lists(bench.program_file(known.name, encoding), encoding);
  };
  bench.compare(known.name,
                {parallax_lists(bench.model_file(known.name)), clingo(Encoding::kExported),
                 clingo(Encoding::kTuned)},
                known.traces);
}

}  // namespace

void measure_counting(Bench& bench) {
  bench.begin("counting all traces");
  for (const auto& known : {Known{"robot_4_2_4", "3488"},
                            {"robot_4_2_8", "1759222"},
                            {"lamps_4_6", "1048576"},
                            {"bankplan_3_12_4_5", "10720"},
                            {"robot_6_4_2", "2076"}}) {
    compare_counts(bench, known);
  }
  bench.begin("counting more than can be listed");
  compare_counts(bench, {"roaming_6_4_30", "36576324650499955"});
  compare_counts(bench, {"roaming_6_12_40", "7067596208426570798154076"});
  bench.begin("counting where clauses look far");
  compare_counts(bench, {"distant_4_6", "331776"});
  compare_counts(bench, {"distant_8_30",
                         "690953945637403701925040179632561706444270720923002718939534323613696"});
  bench.begin("deciding that there is no trace");
  compare_counts(bench, {"robot_6_4_m1", "0"});
  bench.begin("deciding that there is no trace of things that are interchangeable");
  for (const auto* name : {"pigeon_9_8", "pigeon_10_9", "pigeon_11_10", "pigeon_20_19",
                           "ringed_9_8", "ringed_10_9", "ringed_20_19"}) {
    compare_configurations(bench, {name, "0"});
  }
}

void measure_listing(Bench& bench) {
  bench.begin("listing all traces to a file");
  for (const auto& known :
       {Known{"robot_4_2_4", "3488"}, {"lamps_4_6", "1048576"}, {"robot_4_2_8", "1759222"}}) {
    compare_lists(bench, known);
  }
}

}  // namespace parallax::tools
