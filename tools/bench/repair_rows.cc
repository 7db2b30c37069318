// Mistakes put into models whose worlds are known, and how many of them `parallax repair` finds.

#include <fmt/core.h>

#include "tools/bench/bench.h"
#include "tools/bench/mistakes/mistake_bench.h"
#include "tools/bench/mistakes/mistake_table.h"

namespace parallax::tools {

void measure_repair(Bench& bench) {
  bench.begin("repairs of models with mistakes");
  MistakeBenchOptions options;
  options.trial.worlds = PARALLAX_SOURCE_DIR "/tools/bench/mistakes/worlds";
  options.trial.program = parallax_program();
  options.trial.folder = bench.path("mistakes");
  std::string error;
  const auto outcomes = measure_mistakes(
      options, {}, [](const MistakeOutcome& outcome) { (void)outcome; }, error);
  if (!error.empty()) {
    Side side;
    side.program = "parallax";
    side.answer = error;
    bench.add({"", "worlds", {side}, "ready", ""});
  }
  for (const auto& row : count_mistakes(outcomes)) {
    bench.add({"", row.name, {}, std::nullopt, to_words(row)});
  }
}

}  // namespace parallax::tools
