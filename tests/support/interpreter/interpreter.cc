#include "tests/support/interpreter/interpreter.h"

#include <stdexcept>

#include "tests/support/interpreter/evaluator.h"

namespace parallax::test {

Executions execute_all(std::string_view plan, World& world, int horizon, bool by_turns,
                       std::size_t most) {
  const auto program = read_data(plan);
  Executions out;
  for (std::size_t start = 0; start < world.initial_states(); ++start) {
    // Depth first through the picks: the last one that has another choice is moved on.
    std::vector<Pick> picks;
    do {
      world.reset(start);
      Evaluator evaluator(program, world, horizon, picks, by_turns);
      const auto end = evaluator.run();
      if (++out.runs > most) throw std::length_error("too many runs");
      if (end.kind == Ending::Kind::kHit) out.keys.insert(end.text);
      if (end.kind == Ending::Kind::kBeyond) out.beyond_horizon = true;
      if (end.kind == Ending::Kind::kFailed) out.failures.insert(end.text);
      picks = evaluator.picks();
      while (!picks.empty() && ++picks.back().chosen == picks.back().choices) picks.pop_back();
    } while (!picks.empty());
  }
  return out;
}

}  // namespace parallax::test
