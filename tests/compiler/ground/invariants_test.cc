#include "compiler/ground/invariants.h"

#include <set>

#include "compiler/cnf/encoder.h"
#include "compiler/ground/grounder.h"
#include "runtime/enumerate/model_enumerator.h"
#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

using compiler::AtomKind;
using compiler::CompiledModel;

CompiledModel compiled(const std::string& text, bool invariants) {
  CheckedText checked(text);
  REQUIRE_MESSAGE(checked.model, checked.text());
  compiler::GroundOptions options;
  options.invariants = invariants;
  auto ground = compiler::ground_model(*checked.model, options, checked.sink);
  REQUIRE_MESSAGE(ground, checked.text());
  return compiler::encode(*ground);
}

/// The invariants' clauses at timepoint 0 as atoms: "-A -B" for at most one, "A B C" for at least
/// one.
std::set<std::string> invariants_of(const std::string& text) {
  const auto model = compiled(text, true);
  std::set<std::string> found;
  for (const auto& section : model.sections) {
    for (auto i = section.begin; i < section.begin + section.clauses; ++i) {
      if (model.origins[model.clause_origins[i]].kind != compiler::OriginKind::kInvariant) continue;
      std::set<std::string> literals;
      for (const auto literal : model.clauses[i]) {
        const auto atom = model.atom(literal.var());
        REQUIRE(atom.kind == AtomKind::kHoldsAt);
        literals.insert((literal.is_positive() ? "" : "-") + atom.name);
      }
      std::string clause;
      for (const auto& literal : literals) clause += (clause.empty() ? "" : " ") + literal;
      found.insert(clause);
    }
  }
  return found;
}

std::vector<std::string> traces_of(const std::string& text, bool invariants) {
  const auto model = compiled(text, invariants);
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  std::vector<std::string> traces;
  while (const auto trace = enumerator.next()) traces.push_back(runtime::to_text(*trace));
  return traces;
}

const std::string kRobot =
    "sort room: integer\nsort thing\nthing Cup, Pan\n"
    "fluent In(room)\nfluent Held(thing)\nevent Go(room)\nevent Take(thing)\nevent Drop(thing)\n"
    "[room,time] Initiates(Go(room),In(room),time).\n"
    "[room1,room2,time] HoldsAt(In(room1),time) & room1!=room2 ->\n"
    "  Terminates(Go(room2),In(room1),time).\n"
    "[thing,time] Initiates(Take(thing),Held(thing),time).\n"
    "[thing,time] Terminates(Drop(thing),Held(thing),time).\n"
    "range time 0 2\nrange room 1 3\n";
const std::string kOneAtATime =
    "[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> event1=event2.\n";
const std::string kStart =
    "[room] HoldsAt(In(room),0) <-> room=2.\n[thing] !HoldsAt(Held(thing),0).\n";
const std::string kFreeHand =
    "[thing1,thing2,time] Happens(Take(thing1),time) -> !HoldsAt(Held(thing2),time).\n";

}  // namespace

TEST_CASE("a robot is in exactly one room and holds at most one thing") {
  const auto found = invariants_of(kRobot + kOneAtATime + kStart + kFreeHand);
  CHECK(found == std::set<std::string>{"-In(1) -In(2)", "-In(1) -In(3)", "-In(2) -In(3)",
                                       "In(1) In(2) In(3)", "-Held(Cup) -Held(Pan)"});
}

TEST_CASE("an invariant needs every reason for it") {
  SUBCASE("without the precondition two things can be held") {
    const auto found = invariants_of(kRobot + kOneAtATime + kStart);
    CHECK(found.count("-Held(Cup) -Held(Pan)") == 0);
    CHECK(found.count("In(1) In(2) In(3)") == 1);
  }
  SUBCASE("two hands can take at once, but nobody can go to two rooms: each ends the other") {
    const auto found = invariants_of(kRobot + kStart + kFreeHand);
    CHECK(found.count("-Held(Cup) -Held(Pan)") == 0);
  }
  SUBCASE("the start has to be stated") {
    const auto found = invariants_of(kRobot + kOneAtATime + kFreeHand +
                                     "[thing] !HoldsAt(Held(thing),0).\nHoldsAt(In(2),0).\n");
    CHECK(found == std::set<std::string>{"-Held(Cup) -Held(Pan)"});
  }
  SUBCASE("two at the start are not one") {
    const auto found = invariants_of(kRobot + kOneAtATime + kFreeHand +
                                     "[room] HoldsAt(In(room),0) <-> room!=2.\n"
                                     "[thing] HoldsAt(Held(thing),0).\n");
    CHECK(found.empty());
  }
  SUBCASE("what is released obeys nothing") {
    const auto found = invariants_of(kRobot + kOneAtATime + kStart + kFreeHand +
                                     "event Trip()\n[room,time] Releases(Trip(),In(room),time).\n");
    CHECK(found == std::set<std::string>{"-Held(Cup) -Held(Pan)"});
  }
  SUBCASE("who leaves without arriving is nowhere") {
    const auto found =
        invariants_of(kRobot + kOneAtATime + kStart + kFreeHand +
                      "event Vanish()\n[room,time] Terminates(Vanish(),In(room),time).\n");
    CHECK(found.count("-In(1) -In(2)") == 1);
    CHECK(found.count("In(1) In(2) In(3)") == 0);
  }
}

TEST_CASE("invariants change no trace") {
  const std::string models[] = {kRobot + kOneAtATime + kStart + kFreeHand,
                                kRobot + kOneAtATime + kStart, kRobot + kStart + kFreeHand,
                                kRobot + kStart};
  for (const auto& model : models) {
    const auto with = traces_of(model, true);
    CHECK(with == traces_of(model, false));
    CHECK(with.size() > 10);
  }
}

}  // namespace parallax::test
