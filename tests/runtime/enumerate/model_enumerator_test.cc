#include "runtime/enumerate/model_enumerator.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/runtime/enumerate/brute_force.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

/// The enumerated traces are those that brute force over all atoms accepts, each once.
void check_against_brute_force(const std::string& text, std::size_t expected) {
  CAPTURE(text);
  TextModel model(text);
  REQUIRE(!model.sink.has_errors());
  REQUIRE(model.ground != nullptr);
  auto found = enumerate_all(*model.typed, model.compiled);
  const auto wanted = BruteForce(*model.typed).signatures();
  const auto count = found.size();
  std::sort(found.begin(), found.end());
  CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
  CHECK(std::set<std::string>(found.begin(), found.end()) == wanted);
  CHECK(count == expected);
}

TEST_CASE("inertia: without effects a fluent keeps its value, and events are free") {
  check_against_brute_force("range time 0 2\nfluent F()\nevent E()\n", 2 * 4);
}

TEST_CASE("initiates and terminates with conditions") {
  check_against_brute_force(
      "range time 0 2\nfluent F()\nfluent G()\nevent E()\n"
      "[time] HoldsAt(G(),time) -> Initiates(E(),F(),time).\n"
      "[time] HoldsAt(F(),time) -> Terminates(E(),G(),time).\n",
      16);
}

TEST_CASE("a predicate that only a trajectory's condition mentions is completed") {
  check_against_brute_force(
      "range time 0 1\nrange offset 1 1\nfluent F()\nfluent G()\npredicate P()\nevent E()\n"
      "[time] Initiates(E(),F(),time).\n"
      "[time,offset] P() -> Trajectory(F(),time,G(),offset).\ncompletion P\n"
      "!HoldsAt(F(),0).\n",
      4);
}

TEST_CASE("of two completions of one predicate both count") {
  check_against_brute_force(
      "range time 0 1\nfluent F()\nevent A()\nevent B()\n"
      "One: HoldsAt(F(),0) -> Happens(A(),0).\nTwo: Happens(A(),0) | Happens(B(),0).\n"
      "completion One Happens\ncompletion Two Happens\nHoldsAt(F(),0).\n",
      1);
}

TEST_CASE("an atom that no axiom gives a reason for under one of the completions is false") {
  check_against_brute_force(
      "range time 0 1\nfluent F()\nevent A()\nevent B()\n"
      "One: HoldsAt(F(),0) -> Happens(A(),0).\nTwo: !HoldsAt(F(),0) -> Happens(B(),0).\n"
      "completion One Happens\ncompletion Two Happens\n",
      0);
}

TEST_CASE("completed, ReleasedAt needs a reason among the axioms") {
  check_against_brute_force(
      "range time 0 1\nfluent F()\nevent A()\n[time] Releases(A(),F(),time).\n"
      "completion ReleasedAt\n!HoldsAt(F(),0).\n",
      1);
}

TEST_CASE("what stands below a quantifier over nothing does not say which timepoints exist") {
  check_against_brute_force(
      "range time 0 2\nsort ghost\nevent A()\nevent B()\n"
      "[time] Happens(A(),time) <-> ([ghost] Happens(B(),time-1)).\n",
      4);
  check_against_brute_force(
      "range time 0 1\nsort thing\nevent A(thing)\nevent B()\n"
      "[thing,time,time1] Happens(A(thing),time1+1).\n",
      2);
  TextModel none("range time 0 1\nsort ghost\nevent A()\n[time] {ghost} Happens(A(),time+1).\n");
  CHECK(none.codes().find("E3003") != std::string::npos);
}

TEST_CASE("an effect axiom whose time is computed counts for a scheduled event") {
  check_against_brute_force(
      "range time 0 1\nfluent F()\nevent E()\n[time] Terminates(E(),F(),time-1).\n"
      "Happens(E(),0).\ncompletion Happens\n",
      2);
}

TEST_CASE("the effect of a completed occurrence may depend on what holds later or at any time") {
  // Both effects would take place at 0: contradiction.
  check_against_brute_force(
      "range time 0 3\nfluent F()\nevent E()\n"
      "[time]({time1} HoldsAt(F(),time1)) -> Terminates(E(),F(),time).\n"
      "[time] Initiates(E(),F(),time).\n!HoldsAt(F(),0).\nHappens(E(),0).\n"
      "completion Happens\n",
      0);
  check_against_brute_force(
      "range time 0 2\nfluent F()\nfluent G()\nevent E()\n"
      "[time] HoldsAt(F(),time+1) -> Initiates(E(),G(),time).\n"
      "[time] Initiates(E(),F(),time).\n!HoldsAt(F(),0).\n!HoldsAt(G(),0).\nHappens(E(),0).\n"
      "completion Happens\n",
      1);
}

TEST_CASE("a formula may speak of the effects of an event that never happens") {
  check_against_brute_force(
      "range time 0 2\nfluent F()\nfluent G()\nevent E()\n"
      "[event,time] Initiates(event,F(),time).\n"
      "[time] Initiates(E(),F(),1) -> HoldsAt(G(),time).\ncompletion Happens\n",
      2);
}

TEST_CASE("computed arguments of an effect's event are matched with every operator") {
  for (const std::string zero : {"2%2", "0*2", "1/2", "2-2", "(0-2)%2"}) {
    check_against_brute_force(
        "range time 0 1\nsort level: integer\nrange level 0 0\nfluent F()\n"
        "event E(level,level)\nHoldsAt(F(),0).\nHappens(E(0,0),0).\n"
        "[time] Terminates(E(time," +
            zero + "),F(),time).\n",
        1);
  }
}

TEST_CASE("timepoints come from several ranges in any order, without a gap") {
  TextModel both("range time 2 2\nrange time 0 1\nfluent F()\nHoldsAt(F(),0).\n");
  CHECK(both.codes() == "W2008");
  CHECK(enumerate_all(*both.typed, both.compiled).size() == 1);
  CHECK(both.compiled.horizon == 2);
  TextModel gap("range time 0 1\nrange time 3 4\nfluent F()\nHoldsAt(F(),0).\n");
  CHECK(gap.codes().find("E3015") != std::string::npos);
}

TEST_CASE("an event that initiates and terminates one fluent is impossible") {
  check_against_brute_force(
      "range time 0 1\nfluent F()\nevent E()\n"
      "[time] Initiates(E(),F(),time).\n[time] Terminates(E(),F(),time).\n",
      2);
}

TEST_CASE("a released fluent may change without an event") {
  check_against_brute_force(
      "range time 0 2\nfluent F()\nevent E()\n"
      "[time] Releases(E(),F(),time).\n!HoldsAt(F(),0).\nHappens(E(),0).\n",
      2 * 4);
}

TEST_CASE("a noninertial fluent is tied to others by its definition only") {
  check_against_brute_force(
      "range time 0 1\nfluent F()\nfluent D()\nnoninertial D\nevent E()\n"
      "[time] Initiates(E(),F(),time).\n[time] HoldsAt(D(),time) <-> !HoldsAt(F(),time).\n",
      4);
}

TEST_CASE("sorts with arguments, equations and quantifiers inside") {
  check_against_brute_force(
      "range time 0 1\nsort thing\nthing A, B\nfluent On(thing)\nevent Press(thing)\n"
      "[thing,time] Initiates(Press(thing),On(thing),time).\n"
      "[thing1,thing2,time] Happens(Press(thing1),time) & Happens(Press(thing2),time) -> "
      "thing1=thing2.\n"
      "[time] {thing} HoldsAt(On(thing),time).\n",
      9);
}

TEST_CASE("preconditions look at the timepoint of the event, effects come one later") {
  check_against_brute_force(
      "range time 0 3\nfluent F()\nevent E()\n"
      "[time] Happens(E(),time) -> !HoldsAt(F(),time).\n"
      "[time] Initiates(E(),F(),time).\n!HoldsAt(F(),0).\n",
      4);
}

TEST_CASE("an instance beyond the horizon says nothing") {
  check_against_brute_force(
      "range time 0 2\nfluent F()\nevent E()\n"
      "[time] HoldsAt(F(),time) -> HoldsAt(F(),time+1).\n"
      "[time] HoldsAt(F(),time) -> {event} Happens(event,time).\n"
      "[time] Terminates(E(),F(),time).\n",
      4);
}

TEST_CASE("a formula that names an event at the last timepoint needs a longer horizon") {
  const std::string head = "range time 0 1\nfluent F()\nevent E()\n";
  for (const auto* formula :
       {"Happens(E(),1).", "!Happens(E(),1).", "[event] !Happens(event,1).",
        "{event} Happens(event,1).", "Happens(E(),1) | HoldsAt(F(),0).",
        "Happens(E(),0) -> Happens(E(),1).", "[time] HoldsAt(F(),time) -> Happens(E(),1).",
        "[time] time=1 -> Happens(E(),1)."}) {
    CAPTURE(formula);
    CHECK(TextModel(head + formula + '\n').codes() == "E3004");
  }
  // Reached by a variable the instance says nothing, and the others remain.
  check_against_brute_force(head + "[time] time=1 -> Happens(E(),time).\n", 4);
}

TEST_CASE("completion: what has no reason does not happen") {
  TextModel model(
      "range time 0 2\nfluent F()\nevent E()\nevent G()\n[time] Initiates(E(),F(),time).\n"
      "[time] HoldsAt(F(),time) -> Happens(G(),time).\nHappens(E(),0).\ncompletion Happens\n"
      "!HoldsAt(F(),0).\n");
  REQUIRE(!model.sink.has_errors());
  const auto found = enumerate_all(*model.typed, model.compiled);
  REQUIRE(found.size() == 1);
  CHECK(found.front() == ";F() ;F() ;|E() ;G() ;;|");
}

TEST_CASE("completion of a disjunction makes the events exclusive") {
  TextModel model(
      "range time 0 1\nfluent F()\nevent E()\nevent G()\nHappens(E(),0) | Happens(G(),0).\n"
      "HoldsAt(F(),0).\ncompletion Happens\n");
  REQUIRE(!model.sink.has_errors());
  CHECK(enumerate_all(*model.typed, model.compiled).size() == 2);
}

TEST_CASE("completion with a label takes the other formulas for constraints") {
  TextModel model(
      "range time 0 2\nfluent F()\nevent E()\nHoldsAt(F(),0).\n"
      "Delta: Happens(E(),0).\nHappens(E(),1).\ncompletion Delta Happens\n");
  REQUIRE(!model.sink.has_errors());
  CHECK(enumerate_all(*model.typed, model.compiled).empty());
}

TEST_CASE("a trajectory fixes another fluent until its own is terminated") {
  TextModel model(
      "range time 0 3\nrange offset 1 3\nsort height: integer\nrange height 0 6\n"
      "fluent Falling()\nfluent Height(height)\nnoninertial Height\n"
      "event Drop()\nevent Catch()\n"
      "[time] {height} HoldsAt(Height(height),time).\n"
      "[height1,height2,time] HoldsAt(Height(height1),time) & HoldsAt(Height(height2),time) -> "
      "height1=height2.\n"
      "[time] Initiates(Drop(),Falling(),time).\n[time] Terminates(Catch(),Falling(),time).\n"
      "[height1,height2,offset,time] HoldsAt(Height(height1),time) & height2=height1-2*offset -> "
      "Trajectory(Falling(),time,Height(height2),offset).\n"
      "!HoldsAt(Falling(),0).\nHoldsAt(Height(6),0).\nHappens(Drop(),0).\nHappens(Catch(),1).\n"
      "completion Happens\n");
  REQUIRE(!model.sink.has_errors());
  const auto found = enumerate_all(*model.typed, model.compiled);
  // The height is 4 at 1; the catch at 1 lies strictly between 0 and 2, so 2 and 3 are free.
  CHECK(found.size() == 7 * 7);
}

TEST_CASE("user predicates are hidden: they neither duplicate nor lose a trace") {
  check_against_brute_force(
      "range time 0 1\nsort thing\nthing A, B\npredicate P(thing)\nfluent F()\nevent E()\n"
      "[time] HoldsAt(F(),time) -> {thing} P(thing).\n",
      4);
}

TEST_CASE("an unsatisfiable model has no trace") {
  check_against_brute_force("range time 0 1\nfluent F()\nHoldsAt(F(),0).\n!HoldsAt(F(),1).\n", 0);
}

TEST_CASE("traces come in canonical order, whatever was asked of the solver before") {
  TextModel model("range time 0 1\nfluent F()\nfluent G()\nevent E()\n");
  REQUIRE(!model.sink.has_errors());
  const auto first = enumerate_all(*model.typed, model.compiled);
  // Time, then declaration order, false before true: the first trace is the empty one.
  REQUIRE(first.size() == 8);
  CHECK(first.front() == ";;|;;|");
  CHECK(first.back() == "F() G() ;F() G() ;|E() ;;|");
  CHECK(enumerate_all(*model.typed, model.compiled) == first);
}

}  // namespace
}  // namespace parallax::test
