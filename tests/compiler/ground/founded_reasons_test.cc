// `option founded on`: reasons of completed atoms that do not go in circles.

#include <doctest/doctest.h>

#include <sstream>

#include "tests/support/checked_traces.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using Strings = std::vector<std::string>;

const std::string kOption = "option founded on\n";
const std::string kEvents = "range time 0 1\nevent A()\nevent B()\nevent C()\n";
const std::string kCircle =
    "[time] Happens(A(),time) -> Happens(B(),time).\n"
    "[time] Happens(B(),time) -> Happens(A(),time).\n";

/// The number of traces, each of which the reference evaluator accepts.
std::size_t traces(const std::string& text) {
  const TextModel model(text);
  REQUIRE_MESSAGE(model.ground, model.codes() << "\n" << text);
  return checked_traces(*model.typed, model.compiled).size();
}

/// "E3022 4: message" for each error.
Strings errors(const std::string& text, const compiler::GroundOptions& options = {}) {
  const TextModel model(text, options);
  Strings out;
  for (const auto& one : model.sink.sorted()) {
    const auto line = model.files[one.range->file].position(one.range->begin).line;
    out.push_back(std::string(base::info(one.code).id) + " " + std::to_string(line) + ": " +
                  one.message);
  }
  return out;
}

std::string clauses(const std::string& text) {
  const TextModel model(text);
  REQUIRE_MESSAGE(model.ground, model.codes());
  std::ostringstream out;
  for (const auto& constraint : model.ground->constraints()) {
    out << constraint.formula.bits() << ' ' << constraint.width << '\n';
  }
  return out.str();
}

TEST_CASE("events that demand each other do not happen unless something else demands one") {
  const auto text = kEvents + kCircle + "completion Happens\n";
  CHECK(traces(text) == 2);
  CHECK(traces("option founded off\n" + text) == 2);
  CHECK(traces(kOption + text) == 1);
  CHECK(traces(kOption + text + "Happens(A(),0).\n") == 1);
  // Three in a circle, and one that an open fluent demands.
  const auto third = text +
                     "fluent F()\n[time] Happens(B(),time) -> Happens(C(),time).\n"
                     "[time] Happens(C(),time) -> Happens(A(),time).\n"
                     "[time] HoldsAt(F(),time) -> Happens(C(),time).\n";
  CHECK(traces(third) == 3);
  CHECK(traces(kOption + third) == 2);
}

TEST_CASE("definitions in both directions, of predicates, and across timepoints") {
  CHECK(traces(kOption + kEvents +
               "[time] Happens(A(),time) <-> Happens(B(),time).\ncompletion Happens\n") == 1);
  const std::string there_and_back =
      "range time 0 2\nevent A()\nevent B()\n"
      "[time] Happens(A(),time) -> Happens(B(),time+1).\n"
      "[time] Happens(B(),time+1) -> Happens(A(),time).\ncompletion Happens\n";
  CHECK(traces(there_and_back) == 2);
  CHECK(traces(kOption + there_and_back) == 1);
  const std::string ways =
      "range time 0 1\nevent Open()\nsort room\nroom R1, R2, R3\npredicate Way(room,room)\n"
      "[room1,room2,room3,time] Way(room1,room2) & Way(room2,room3) -> Way(room1,room3).\n"
      "Happens(Open(),0) -> Way(R1,R2).\nWay(R2,R3).\nWay(R3,R2).\ncompletion Way\n";
  CHECK(traces(kOption + ways) == 2);
}

TEST_CASE("a derivation by way of an effect counts, a circle through one does not") {
  const std::string head =
      "range time 0 1\nfluent F()\nevent A()\nevent B()\nevent C()\n!HoldsAt(F(),0).\n"
      "[time] Happens(A(),time) -> Initiates(B(),F(),time).\n"
      "[time] Initiates(B(),F(),time) -> Happens(A(),time).\ncompletion Happens\n";
  CHECK(traces(head) == 2);
  CHECK(traces(kOption + head) == 1);
  CHECK(traces(kOption + head +
               "[time] Initiates(C(),F(),time).\n"
               "[time] Initiates(C(),F(),time) -> Happens(A(),time).\n") == 1);
}

TEST_CASE("counts in a circle are derived from below") {
  const std::string head =
      "range time 0 1\nsort item\nitem X, Y, Z\npredicate In(item)\npredicate Many()\n"
      "predicate Start()\ncount{item: In(item)}>=2 -> Many().\n[item] Many() -> In(item).\n"
      "Start() -> In(X).\nStart() -> In(Y).\ncompletion In\ncompletion Many\n";
  const auto count = [&](const std::string& text) {
    const TextModel model(text);
    REQUIRE_MESSAGE(model.ground, model.codes());
    runtime::SolverSession session(model.compiled, runtime::make_cadical_solver());
    std::size_t found = 0;
    while (session.solve(model.compiled.horizon, {}) == runtime::SolveStatus::kSatisfiable) {
      ++found;
      std::vector<compiler::Literal> others;
      model.compiled.for_each_atom([&](const compiler::AtomRef& atom) {
        others.push_back(session.value(atom.literal()) ? ~atom.literal() : atom.literal());
      });
      session.add_clause(others);
    }
    return found;
  };
  CHECK(count(head) == 3);
  CHECK(count(kOption + head) == 2);
}

TEST_CASE("without circles, and with the option off, the constraints are the same") {
  const auto chain = kEvents +
                     "fluent F()\n[time] Happens(A(),time) -> Happens(B(),time).\n"
                     "[time] HoldsAt(F(),time) & Happens(B(),time) -> Happens(C(),time).\n"
                     "Happens(A(),0).\ncompletion Happens\n";
  CHECK(clauses(kOption + chain) == clauses(chain));
  const auto circle = kEvents + kCircle + "completion Happens\n";
  CHECK(clauses("option founded off\n" + circle) == clauses(circle));
  CHECK(clauses(kOption + circle).starts_with(clauses(circle)));
}

TEST_CASE("what cannot be founded is told where it stands") {
  const std::string predicates = "range time 0 1\npredicate P()\npredicate Q()\n";
  const std::string both = "P() -> Q().\nQ() -> P().\n";
  CHECK(errors(kOption + predicates + both + "P() | Q().\ncompletion P\ncompletion Q\n") ==
        Strings{"E3022 7: `P()` cannot be founded: it is derived here where `Q()` is false, which "
                "is in a circle with it"});
  CHECK(errors(kOption + predicates + both +
               "Delta: Q() -> P().\ncompletion P\ncompletion Delta P\ncompletion Q\n") ==
        Strings{"E3022 9: `P()` cannot be founded: it is completed more than once, and is in a "
                "circle of reasons"});
  // A disjunction whose atoms do not depend on each other is fine.
  CHECK(errors(kOption + predicates + "P() | Q().\ncompletion P\ncompletion Q\n").empty());
  compiler::GroundOptions old;
  old.meaning = compiler::Meaning::kDecreasoner;
  CHECK(errors(kOption + predicates + both + "completion P\ncompletion Q\n", old) ==
        Strings{"E3023 1: the 2005 reasoner does not found its completions"});
  compiler::GroundOptions small;
  small.max_instances = 4;
  std::string chain = "range time 0 1\npredicate X()\nX() -> P0().\n";
  for (int i = 0; i < 8; ++i) {
    const auto name = "P" + std::to_string(i);
    chain += "predicate " + name + "()\npredicate Y" + std::to_string(i) + "()\n" + name +
             "() & Y" + std::to_string(i) + "() -> P" + std::to_string((i + 1) % 8) +
             "().\ncompletion " + name + "\n";
  }
  const auto large = errors(kOption + chain, small);
  REQUIRE(large.size() == 1);
  CHECK(
      large[0].ends_with("`P0()` cannot be founded: a circle of 8 atoms takes more than 4 "
                         "formulas"));
}

TEST_CASE("a conjunction behind an arrow gives each of its atoms a reason of its own") {
  const std::string text =
      "range time 0 1\npredicate P()\npredicate Q()\npredicate X()\npredicate Y()\n"
      "X() -> ((Y() -> P()) & (!Y() -> Q())).\nP() -> Q().\nQ() -> P().\n"
      "completion P\ncompletion Q\n";
  CHECK(errors(kOption + text).empty());
}

}  // namespace
}  // namespace parallax::test
