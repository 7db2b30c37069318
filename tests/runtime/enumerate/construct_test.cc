// For a small model of every construct of the language, the enumerated traces are exactly the
// assignments that the reference evaluator accepts.

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "tests/runtime/enumerate/brute_force.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

/// Flips every HoldsAt and Happens atom of the valuation, one at a time: results that are no traces
/// must be reported.
void check_mutations(const compiler::ReferenceEvaluator& evaluator, compiler::Valuation valuation,
                     const std::set<std::string>& traces) {
  const auto flip = [](std::set<std::string>& point, const std::string& atom) {
    if (point.erase(atom) == 0) point.insert(atom);
  };
  const auto mutate = [&](std::set<std::string>& point, const std::string& atom) {
    flip(point, atom);
    if (!traces.contains(signature(valuation))) {
      CHECK(!evaluator.violations(valuation, 1).violations.empty());
    }
    flip(point, atom);
  };
  for (std::size_t t = 0; t < valuation.holds.size(); ++t) {
    for (const auto& fluent : evaluator.fluents()) mutate(valuation.holds[t], fluent);
    for (const auto& event : evaluator.events()) mutate(valuation.happens[t], event);
  }
}

/// `expected` is counted by hand.
void compare(const std::string& text, std::size_t expected) {
  CAPTURE(text);
  const TextModel model(text);
  CAPTURE(model.codes());
  REQUIRE(!model.sink.has_errors());
  REQUIRE(model.typed != nullptr);
  BruteForce brute(*model.typed);
  CHECK(brute.evaluator().silent_axioms().empty());
  const auto wanted = brute.signatures();
  std::vector<std::string> found;
  for (const auto& trace : checked_traces(*model.typed, model.compiled)) {
    const auto valuation = tools::valuation_of(trace);
    found.push_back(signature(valuation));
    check_mutations(brute.evaluator(), valuation, wanted);
  }
  CHECK(found.size() == expected);
  std::sort(found.begin(), found.end());
  CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
  CHECK(std::set<std::string>(found.begin(), found.end()) == wanted);
}

TEST_CASE("functions are tables, also of functions of functions") {
  compare(
      "range time 0 1\nsort room\nroom A, B, C\nfunction Next(room): room\n"
      "Next(A)=B. Next(B)=C. Next(C)=A.\nfluent In(room)\nevent Go(room)\n"
      "[room,time] Initiates(Go(room),In(Next(room)),time).\n"
      "[room,time] HoldsAt(In(Next(Next(room))),time) <-> HoldsAt(In(room),0) & time=1.\n",
      1);
}

TEST_CASE("arithmetic rounds quotients towards zero and keeps the dividend's sign") {
  compare(
      "range time 0 0\nsort num: integer\nrange num -3 3\nfluent F(num)\n"
      "[num] HoldsAt(F(num),0) <-> num/2=0-1 | num%2=0-1 | num*num=9 | (num+1)-(0-1)=2.\n",
      1);
}

TEST_CASE("every comparison of integers") {
  compare(
      "range time 0 0\nsort num: integer\nrange num 0 3\nfluent F(num)\n"
      "[num] num<1 -> HoldsAt(F(num),0).\n[num] num>2 -> HoldsAt(F(num),0).\n"
      "[num] num>=1 & num<=1 -> !HoldsAt(F(num),0).\n"
      "[num] num!=2 | num=2 & HoldsAt(F(num),0) | !HoldsAt(F(num),0).\n",
      2);
}

TEST_CASE("an atom whose arithmetic leaves its sort does not exist") {
  compare(
      "range time 0 0\nsort num: integer\nrange num 0 2\nfluent F(num)\n"
      "[num] HoldsAt(F(num),0) -> HoldsAt(F(num+1),0).\n",
      4);
}

TEST_CASE("what does not exist takes the whole instance with it, even beside a true part") {
  // At 1 there is no HoldsAt(F(),2), so nothing is said of G at 1, whatever HoldsAt(F(),0).
  compare(
      "range time 0 1\nfluent F()\nfluent G()\nHoldsAt(F(),0).\n"
      "[time] HoldsAt(F(),0) & HoldsAt(F(),time+1) & HoldsAt(G(),time) | "
      "!HoldsAt(F(),0) & HoldsAt(G(),time).\n",
      1);
  // Neither the true nor the false part of the instance at 1 counts.
  compare("range time 0 1\nfluent F()\n{time} (time=1 | HoldsAt(F(),time+1)).\n", 1);
  compare("range time 0 1\nfluent F()\n[time] time!=1 & HoldsAt(F(),time+1).\n", 1);
}

TEST_CASE("an inner quantifier without an instance takes the outer instance with it") {
  compare(
      "range time 0 1\nfluent F()\nevent E()\n"
      "[time] HoldsAt(F(),time) -> {event} Happens(event,time).\n",
      3);
}

TEST_CASE("an instance that reaches an event at the last timepoint says nothing") {
  compare(
      "range time 0 1\nfluent F()\nevent E()\n[time] time=1 -> Happens(E(),time) & "
      "HoldsAt(F(),time).\n",
      4);
}

TEST_CASE("terms nest: a fluent about a fact about a room") {
  compare(
      "range time 0 1\nsort room\nroom A, B\nreified sort fact\nfact Lit(room)\n"
      "fluent Believes(fact)\nevent Tell(fact)\n"
      "[fact,time] Initiates(Tell(fact),Believes(fact),time).\n"
      "!HoldsAt(Believes(Lit(A)),0).\n!HoldsAt(Believes(Lit(B)),0).\n"
      "[room,time] Happens(Tell(Lit(room)),time) -> room=A.\n",
      2);
}

TEST_CASE("effects under nested conditions, in a conjunction, with a label or a fixed time") {
  compare(
      "range time 0 2\nfluent F()\nfluent G()\nevent E()\n"
      "Sigma: [time] HoldsAt(F(),time) -> (!HoldsAt(G(),time) -> "
      "Initiates(E(),G(),time) & Terminates(E(),F(),time)).\n"
      "Initiates(E(),F(),1).\n!HoldsAt(G(),0).\n",
      // Without F at 0 anything goes; with it, E at 1 alone would begin and end F.
      4 + 2 + 1);
}

TEST_CASE("an effect whose condition does not exist is none") {
  compare(
      "range time 0 2\nfluent F()\nfluent G()\nevent E()\n"
      "[time] HoldsAt(G(),time+2) -> Initiates(E(),F(),time).\n!HoldsAt(F(),0).\n",
      8);
}

TEST_CASE("events at once: their effects come together") {
  compare(
      "range time 0 1\nfluent F()\nfluent G()\nevent E()\nevent D()\n"
      "[time] !Happens(D(),time) -> Initiates(E(),F(),time).\n"
      "[time] Happens(D(),time) -> Initiates(E(),G(),time).\n"
      "!HoldsAt(F(),0).\n!HoldsAt(G(),0).\n",
      4);
}

TEST_CASE("a noninertial fluent cannot be the effect of an event") {
  compare(
      "range time 0 1\nfluent F()\nnoninertial F\nevent E()\n"
      "[time] HoldsAt(F(),time) -> Initiates(E(),F(),time).\n",
      2 * 2 + 2);
}

TEST_CASE("a release ends with the next effect") {
  compare(
      "range time 0 2\nfluent F()\nevent Toss()\nevent Set()\n"
      "[time] Releases(Toss(),F(),time).\n[time] Initiates(Set(),F(),time).\n"
      "!HoldsAt(F(),0).\n[time] !Happens(Toss(),time) | !Happens(Set(),time).\n",
      // By the events at 0 and 1, none, Toss or Set: free values after Toss.
      1 + 2 + 1 + 4 + 4 + 2 + 1 + 2 + 1);
}

TEST_CASE("manualrelease leaves the release at the start open") {
  compare("range time 0 1\nfluent F()\nmanualrelease F\n", 4);
  compare("option manualrelease on\nrange time 0 1\nfluent F()\nReleasedAt(F(),0).\n", 4);
  compare("option manualrelease on\nrange time 0 1\nfluent F()\n!ReleasedAt(F(),0).\n", 2);
}

TEST_CASE("ReleasedAt in a formula is false where nothing releases") {
  compare("range time 0 1\nfluent F()\n[time] ReleasedAt(F(),time) | HoldsAt(F(),time).\n", 1);
}

TEST_CASE("a trajectory leads to its target until the fluent is stopped strictly before") {
  compare(
      "range time 0 2\nrange offset 1 2\nfluent On()\nfluent Up()\nnoninertial Up\n"
      "event Go()\nevent Halt()\n"
      "[time] Initiates(Go(),On(),time).\n[time] Terminates(Halt(),On(),time).\n"
      "[time,offset] Trajectory(On(),time,Up(),offset).\n"
      "!HoldsAt(On(),0).\n!HoldsAt(Up(),0).\nHappens(Go(),0).\n!Happens(Halt(),0).\n"
      "!Happens(Go(),1).\n",
      // Up at 1. At 2 too, unless the halt at 1 leaves it open.
      1 + 2);
}

TEST_CASE("an antitrajectory runs from the event that terminates its fluent") {
  compare(
      "range time 0 2\nrange offset 1 2\nfluent On()\nfluent Cold()\nnoninertial Cold\n"
      "event Go()\nevent Halt()\n"
      "[time] Initiates(Go(),On(),time).\n[time] Terminates(Halt(),On(),time).\n"
      "[time,offset] HoldsAt(On(),time) -> AntiTrajectory(On(),time,Cold(),offset).\n"
      "HoldsAt(On(),0).\n!HoldsAt(Cold(),0).\nHappens(Halt(),0).\n!Happens(Go(),0).\n"
      "!Happens(Halt(),1).\n",
      // Cold at 1. At 2 too, unless Go at 1 leaves it open.
      1 + 2);
}

TEST_CASE("definitions over effects: Started and Stopped") {
  compare(
      "load foundations/ECCausal.e\nrange time 0 1\nfluent F()\nfluent G()\nevent E()\nevent D()\n"
      "[time] Initiates(E(),F(),time).\n"
      "[time] Stopped(G(),time) & Initiated(F(),time) -> Happens(D(),time).\n"
      "[time] Initiates(D(),G(),time).\n",
      // F or E makes F initiated; then, G false asks for D.
      16 - 3);
}

TEST_CASE("an axiom about effects constrains the events") {
  compare(
      "range time 0 1\nfluent F()\nevent E()\n[time] Terminates(E(),F(),time).\n"
      "[event,fluent,time] Happens(event,time) & Terminates(event,fluent,time) -> "
      "HoldsAt(fluent,time).\n",
      3);
}

TEST_CASE("an axiom with effects in its condition is a reason for completion, as every other") {
  const std::string world = "range time 0 1\nfluent A()\nevent Y()\nevent X()\n";
  // Nothing initiates A: Y happens, and A holds or not; without a reason for X it does not happen.
  compare(world + "[time] !Initiates(Y(),A(),time) -> Happens(Y(),time).\ncompletion Happens\n", 2);
  // X happens, Y does not, and A stays what it is.
  compare(world +
              "[time] Initiates(Y(),A(),time).\n"
              "[time] Initiates(Y(),A(),time) -> Happens(X(),time).\ncompletion Happens\n",
          2);
  // Only where A holds.
  compare(world +
              "[time] Initiates(Y(),A(),time).\n"
              "[time] HoldsAt(A(),time) & Initiates(Y(),A(),time) -> Happens(X(),time).\n"
              "completion Happens\n",
          2);
}

TEST_CASE("completion looks at effects from outside: what brings them about is no reason") {
  const std::string world = "range time 0 2\nfluent A()\nfluent B()\nevent X()\nevent Y()\n";
  // X initiates B exactly where X happens. Y happens where it does not, and nothing gives X a
  // reason: Y at 0 and 1, A and B as they like.
  compare(world +
              "[event,time] Happens(event,time) -> Initiates(event,B(),time).\n"
              "[time] !Initiates(X(),B(),time) -> Happens(Y(),time).\ncompletion Happens\n",
          4);
  // E gives itself a reason, by way of its effect: completion asks for a reason, not for a first
  // one.
  compare(
      "range time 0 1\nfluent F()\nevent E()\n"
      "[time] Happens(E(),time) -> Terminates(E(),F(),time).\n"
      "[event,time] Terminates(event,F(),time) -> Happens(E(),0).\ncompletion Happens\n",
      4);
}

TEST_CASE("Clipped counts the terminations of an interval") {
  compare(
      "load foundations/DEC.e\nrange time 0 1\nfluent F()\nevent E()\n"
      "[time] Terminates(E(),F(),time).\n!Clipped(0,F(),1).\n",
      2);
}

TEST_CASE("completion: of events, by label, of a disjunction") {
  compare(
      "range time 0 2\nfluent F()\nevent E()\nevent D()\nHappens(E(),0) | Happens(D(),0).\n"
      "[time] HoldsAt(F(),time) -> Happens(D(),time).\ncompletion Happens\n",
      // Without F one of the two at 0; with F it is D at 0 and 1, and E has no reason.
      2 + 1);
  compare(
      "range time 0 2\nfluent F()\nevent E()\nHoldsAt(F(),0).\nDelta: Happens(E(),0).\n"
      "[time] Happens(E(),time) -> HoldsAt(F(),time).\ncompletion Delta Happens\n",
      1);
}

TEST_CASE("completion asks for a reason beside the atom itself") {
  // E is the reason of D and D of E: together they may happen.
  compare(
      "range time 0 1\nevent E()\nevent D()\nHappens(E(),0) <-> Happens(D(),0).\n"
      "completion Happens\n",
      2);
}

TEST_CASE("completion of a user predicate and of HoldsAt") {
  compare(
      "range time 0 1\nsort thing\nthing A, B\npredicate Odd(thing)\nfluent F(thing)\n"
      "Theta: Odd(A).\n[thing,time] HoldsAt(F(thing),time) -> Odd(thing).\n"
      "completion Theta Odd\n",
      2);
  compare(
      "range time 0 1\nfluent F()\nfluent G()\nHoldsAt(F(),0).\n"
      "[time] HoldsAt(F(),time) -> HoldsAt(F(),time+1).\ncompletion HoldsAt\n",
      1);
}

TEST_CASE("mutex and xor share the arguments of one sort") {
  compare(
      "range time 0 1\nsort arm\narm A, B\nevent Push(arm)\nevent Pull(arm)\nfluent F()\n"
      "mutex Push, Pull\nHoldsAt(F(),0).\n",
      9);
  compare(
      "range time 0 1\nsort arm\narm A, B\nfluent Open(arm)\nfluent Shut(arm)\nxor Open, Shut\n",
      4);
}

TEST_CASE("user predicates over time, in definitions and as free choices") {
  compare(
      "range time 0 1\nsort thing\nthing A, B\npredicate P(thing,time)\nfluent F(thing)\n"
      "[thing,time] P(thing,time) <-> HoldsAt(F(thing),time).\n"
      "[time] {thing} P(thing,time).\n",
      3);
}

TEST_CASE("subsorts: a variable of the wide sort, an argument of the narrow one") {
  compare(
      "range time 0 0\nsort object\nsort agent: object\nobject Box\nagent Ann\nfluent "
      "Awake(agent)\n"
      "fluent Seen(object)\n[object] HoldsAt(Seen(object),0) -> HoldsAt(Awake(object),0).\n",
      6);
}

TEST_CASE("effect constraints: an effect brings others with it, the least that follow") {
  const std::string turkey =
      "range time 0 1\nfluent Alive()\nfluent Walking()\nevent Shoot()\nevent Sneeze()\n"
      "[time] Terminates(Shoot(),Alive(),time).\n"
      "HoldsAt(Alive(),0). HoldsAt(Walking(),0).\n";
  // Either event or not; the shot ends both.
  compare(
      turkey + "[event,time] Terminates(event,Alive(),time) -> Terminates(event,Walking(),time).",
      4);
  // Both ways round, nothing more follows.
  compare(turkey +
              "[event,time] Terminates(event,Alive(),time) -> Terminates(event,Walking(),time)."
              "[event,time] Terminates(event,Walking(),time) -> Terminates(event,Alive(),time).",
          4);
  // Effects that only cause each other never occur.
  compare(
      "range time 0 1\nfluent F()\nfluent G()\nevent E()\n!HoldsAt(F(),0). !HoldsAt(G(),0).\n"
      "[event,time] Initiates(event,F(),time) -> Initiates(event,G(),time).\n"
      "[event,time] Initiates(event,G(),time) -> Initiates(event,F(),time).\n",
      2);
  // The tray tied to the trolley moves with it, the book if it is tied to the tray: pushed or not,
  // tied or not.
  compare(
      "range time 0 1\nsort thing\nthing Trolley, Tray, Book\nfluent Away(thing)\n"
      "fluent Tied(thing)\nevent Push()\nfunction Base(thing): thing\n"
      "Base(Trolley)=Trolley. Base(Tray)=Trolley. Base(Book)=Tray.\n"
      "[time] Initiates(Push(),Away(Trolley),time).\n"
      "[event,thing,time] Initiates(event,Away(Base(thing)),time) & HoldsAt(Tied(thing),time) -> "
      "Initiates(event,Away(thing),time).\n"
      "[thing] !HoldsAt(Away(thing),0).\nHoldsAt(Tied(Tray),0). !HoldsAt(Tied(Trolley),0).\n",
      4);
}

TEST_CASE("effect constraints: denied, quantified, at another timepoint, in releases") {
  // D sets G; an event that does not set G sets F. Then an event that sets F at one timepoint ends
  // it at the next, so it can happen at the first only.
  compare(
      "range time 0 1\nfluent F()\nfluent G()\nevent E()\nevent D()\n"
      "!HoldsAt(F(),0). !HoldsAt(G(),0).\n[time] Initiates(D(),G(),time).\n"
      "[event,time] !Initiates(event,G(),time) -> Initiates(event,F(),time).\n",
      4);
  compare(
      "range time 0 2\nsort a\na A, B\nfluent F(a)\nfluent G()\nevent E(a)\n"
      "[a] !HoldsAt(F(a),0). !HoldsAt(G(),0).\n[a,time] Initiates(E(a),F(a),time).\n"
      "[a,time] ({a1} Initiates(E(a),F(a1),time-1)) -> Terminates(E(a),F(a),time).\n"
      "[time] !Happens(E(B),time).",
      2);
  compare(
      "range time 0 1\nfluent F()\nfluent G()\nevent E()\n!HoldsAt(F(),0). !HoldsAt(G(),0).\n"
      "[time] Initiates(E(),F(),time).\n"
      "[event,time] Initiates(event,F(),time) -> Releases(event,G(),time).\n",
      3);
}

TEST_CASE("effect constraints: an effect that depends on its own absence is refused") {
  const std::string world = "range time 0 1\nfluent F()\nfluent G()\nevent E()\n";
  const TextModel cycle(world +
                        "[event,time] !Initiates(event,F(),time) -> Initiates(event,G(),time).\n"
                        "[event,time] Initiates(event,G(),time) -> Initiates(event,F(),time).\n");
  CHECK(cycle.codes().find("E3016") != std::string::npos);
  const TextModel tautology(
      world +
      "[event,time] Initiates(event,F(),time) | !Initiates(event,F(),time) -> "
      "Initiates(event,F(),time).\n");
  CHECK(tautology.codes().find("E3016") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
