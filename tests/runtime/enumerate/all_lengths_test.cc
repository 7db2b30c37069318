// Where the whole model is loaded, one call asks for traces of all lengths: it changes no answer.

#include <doctest/doctest.h>

#include <string>

#include "compiler/pipeline/compile.h"
#include "runtime/enumerate/plan_enumerator.h"

namespace parallax::test {
namespace {

/// A robot on a row of five rooms, from the first on. `forced`: it goes on at every step. Where
/// there is an alarm nothing can follow.
std::string row_of_rooms(bool forced, int alarm) {
  std::string text =
      "sort room: integer\nrange room 1 5\nfluent At(room)\nevent Go(room)\n"
      "[room,time] Initiates(Go(room),At(room),time).\n"
      "[room1,room2,time] room1!=room2 -> Terminates(Go(room1),At(room2),time).\n"
      "[room,time] Happens(Go(room),time) -> "
      "({room1} HoldsAt(At(room1),time) & room=room1+1).\n"
      "[room] HoldsAt(At(room),0) <-> room=1.\n";
  if (forced) text += "[room,time] HoldsAt(At(room),time) & room<5 -> Happens(Go(room+1),time).\n";
  if (alarm > 0) {
    text += "event Ring()\n[time] HoldsAt(At(" + std::to_string(alarm) +
            "),time) -> Happens(Ring(),time).\n[time] !Happens(Ring(),time).\n";
  }
  return text;
}

struct Answer {
  int length = -1;  // none: no trace
  runtime::Exploration exploration = runtime::Exploration::kStopped;
  std::optional<compiler::Timepoint> dead_end;
  friend bool operator==(const Answer&, const Answer&) = default;
};

Answer first_trace(const compiler::CompiledModel& model, runtime::Loading loading) {
  runtime::SolverSession session(model, runtime::make_cadical_solver(), loading);
  runtime::PlanEnumerator enumerator(session, {.order = runtime::TraceOrder::kAny});
  Answer answer;
  if (const auto trace = enumerator.next()) answer.length = static_cast<int>(trace->length());
  answer.exploration = enumerator.exploration();
  answer.dead_end = enumerator.dead_end();
  return answer;
}

TEST_CASE("one call for all lengths: the same first trace, exploration and dead end") {
  int with_trace = 0, without = 0, dead = 0;
  for (const bool at_start : {false, true}) {
    for (const bool forced : {false, true}) {
      for (const int alarm : {0, 2, 4}) {
        for (const int horizon : {1, 3, 5}) {
          for (int goal = 1; goal <= 5; ++goal) {
            base::SourceFiles files;
            base::DiagnosticSink sink;
            compiler::CompileInput input;
            input.text = files.add("model.e", row_of_rooms(forced, alarm));
            input.horizon = horizon;
            const auto formula = "HoldsAt(At(" + std::to_string(goal) + "),time)";
            const auto file = files.add("--until", formula);
            const base::SourceRange range{file, 0, static_cast<std::uint32_t>(formula.size())};
            input.constraints = {{range, range, false}};
            input.hits_at_start = at_start;
            const auto compiled = compiler::compile_model(input, files, sink);
            REQUIRE(compiled);
            const auto expected = first_trace(compiled->model, runtime::Loading::kAsNeeded);
            CAPTURE(at_start);
            CAPTURE(forced);
            CAPTURE(alarm);
            CAPTURE(horizon);
            CAPTURE(goal);
            CHECK(first_trace(compiled->model, runtime::Loading::kWhole) == expected);
            (expected.length >= 0 ? with_trace : without) += 1;
            if (expected.dead_end) ++dead;
          }
        }
      }
    }
  }
  CHECK(with_trace > 20);
  CHECK(without > 20);
  CHECK(dead > 5);
}

}  // namespace
}  // namespace parallax::test
