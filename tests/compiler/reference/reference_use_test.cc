#include "compiler/reference/reference_use.h"

#include <doctest/doctest.h>

#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

using compiler::ReferenceUse;
using Indices = std::set<std::size_t>;

TEST_CASE(
    "what a trace makes use of: effects whose condition holds, axioms that its events are in") {
  const CheckedText model(
      "range time 0 3\n"
      "fluent On()\nfluent Warm()\nfluent Loud()\nevent Press()\nevent Kick()\n"
      "[time] Initiates(Press(),On(),time).\n"                                        // effect 0
      "[time] HoldsAt(On(),time) -> Initiates(Press(),Warm(),time).\n"                // effect 1
      "[time] Terminates(Kick(),On(),time).\n"                                        // effect 2
      "[event,time] Initiates(event,Warm(),time) -> Initiates(event,Loud(),time).\n"  // effect 3
      "!HoldsAt(On(),0).\n"                                                           // axiom 0
      "[time] Happens(Kick(),time) -> HoldsAt(On(),time).\n"                          // axiom 1
      "[time] Happens(Press(),time) -> !Happens(Kick(),time).\n"                      // axiom 2
      "Happens(Press(),2) -> HoldsAt(On(),0).\n");                                    // axiom 3
  REQUIRE(model.model.has_value());
  const compiler::ReferenceEvaluator evaluator(*model.model);
  const ReferenceUse use(evaluator);
  const auto of = [&](std::vector<std::set<std::string>> holds,
                      std::vector<std::set<std::string>> happens) {
    return use.of({std::move(holds), std::move(happens), {}, {}});
  };
  const auto once = of({{}, {"On()"}}, {{"Press()"}, {}});
  CHECK(once.effects == Indices{0});
  CHECK(once.axioms == Indices{2});
  // The condition holds the second time, and then the effect brings another with it.
  const auto twice =
      of({{}, {"On()"}, {"On()", "Warm()", "Loud()"}}, {{"Press()"}, {"Press()"}, {}});
  CHECK(twice.effects == Indices{0, 1, 3});
  const auto kicked = of({{}, {"On()"}, {}}, {{"Press()"}, {"Kick()"}, {}});
  CHECK(kicked.effects == Indices{0, 2});
  CHECK(kicked.axioms == Indices{1, 2});
  // Nothing happens at the last timepoint of a trace.
  CHECK(of({{}}, {{"Press()"}}).effects.empty());
  CHECK(of({{}}, {{"Press()"}}).axioms.empty());
}

}  // namespace
}  // namespace parallax::test
