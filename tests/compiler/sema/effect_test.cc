// Formulas that are effect and trajectory axioms, and the meaning of other mentions of effects.

#include <doctest/doctest.h>

#include "tests/compiler/front_end.h"
#include "tests/compiler/typed_text.h"

namespace parallax::test {
namespace {

constexpr const char* kWorld =
    "sort a\na A\nrange time 0 3\nrange offset 1 2\nfluent F()\nfluent G(a)\nevent E()\n"
    "event D(a)\npredicate P(a)\npredicate Q()\n";

/// Effects, trajectories and axioms of the model, in this order, or the codes of the errors.
Strings shapes(const std::string& formulas) {
  const CheckedText checked(kWorld + formulas);
  if (!checked.model) return checked.codes();
  const TypedText text(*checked.model);
  Strings out;
  for (const auto& effect : checked.model->effects) out.push_back(text.effect(effect));
  for (const auto& path : checked.model->trajectories) out.push_back(text.trajectory(path));
  for (const auto& axiom : checked.model->axioms) {
    out.push_back((axiom.mentions_effects ? "mentions: " : "") + text.axiom(axiom));
  }
  return out;
}

Strings warnings(const std::string& formulas) { return CheckedText(kWorld + formulas).codes(); }

TEST_CASE("the plain shapes become effect axioms without a warning") {
  CHECK(shapes("[time] Initiates(E(),F(),time).") ==
        Strings{"[time] true => Initiates(E(),F(),time)"});
  CHECK(shapes("[a,time] P(a) & HoldsAt(F(),time) -> Terminates(D(a),G(a),time).") ==
        Strings{"[a,time] (P(a) & HoldsAt(F(),time)) => Terminates(D(a),G(a),time)"});
  CHECK(shapes("[time] Releases(E(),G(A),time).") ==
        Strings{"[time] true => Releases(E(),G(A),time)"});
  CHECK(shapes("[time] ({a} P(a)) -> Initiates(E(),F(),time).") ==
        Strings{"[time] {a}P(a) => Initiates(E(),F(),time)"});
  CHECK(warnings("[a,time] P(a) -> Initiates(D(a),G(a),time).").empty());
}

TEST_CASE("nested quantifiers, nested conditions and conjunctions are taken apart") {
  CHECK(shapes("[a][time] P(a) -> [a1] Q() -> Initiates(D(a1),G(a),time).") ==
        Strings{"[a,time,a1] (P(a) & Q()) => Initiates(D(a1),G(a),time)"});
  CHECK(shapes("[time] Q() -> (P(A) -> Initiates(E(),F(),time)).") ==
        Strings{"[time] (Q() & P(A)) => Initiates(E(),F(),time)"});
  CHECK(shapes("[time] Q() -> Initiates(E(),F(),time) & Terminates(E(),G(A),time) & P(A).") ==
        Strings{"[time] Q() => Initiates(E(),F(),time)", "[time] Q() => Terminates(E(),G(A),time)",
                "[time](Q() -> (((Happens(E(),time) & HoldsAt(F(),time)) -> (Happens(E(),time) & "
                "HoldsAt(F(),time))) -> (((Happens(E(),time) & HoldsAt(G(A),time)) -> "
                "(Happens(E(),time) & HoldsAt(G(A),time))) -> P(A))))"});
  CHECK(shapes("Initiates(E(),F(),2).") == Strings{"[] true => Initiates(E(),F(),2)"});
  CHECK(shapes("Sigma: [time] Initiates(E(),F(),time).") ==
        Strings{"Sigma: [time] true => Initiates(E(),F(),time)"});
}

TEST_CASE("shapes that the 2005 reasoner gets wrong are warned about, once an axiom") {
  CHECK(warnings("Initiates(E(),F(),2).") == Strings{"W2001"});
  CHECK(warnings("[a][time] Initiates(D(a),G(a),time).") == Strings{"W2001"});
  CHECK(warnings("L: [time] Initiates(E(),F(),time).") == Strings{"W2001"});
  CHECK(warnings("[time] Initiates(E(),F(),time) & Terminates(E(),G(A),time).") ==
        Strings{"W2001"});
  CHECK(warnings("([time] Initiates(E(),F(),time)) & ([time] Q()).") == Strings{"W2001"});
  CHECK(warnings("[time] Q() & (P(A) -> Initiates(E(),F(),time)).") == Strings{"W2001"});
  CHECK(warnings("[time] Q() & P(A) -> Initiates(E(),F(),time).").empty());
  CHECK(warnings("[time] Initiates(E(),F(),3).") == Strings{"W2001"});
  CHECK(warnings("[time] Q() -> (P(A) -> Initiates(E(),F(),time)).") == Strings{"W2001"});
}

TEST_CASE("effects in places where they assert nothing definite are errors at the atom") {
  const auto place = [](const std::string& formula) {
    return CheckedText(kWorld + formula).places();
  };
  CHECK(place("[time] {a} P(a) -> Initiates(D(a),G(a),time).") == Strings{"E2301 11:20-44"});
  CHECK(place("[time] Q() | Initiates(E(),F(),time).") == Strings{"E2301 11:14-36"});
  CHECK(place("[time] !Q() <-> Initiates(E(),F(),time).") == Strings{"E2301 11:17-39"});
  CHECK(place("[time] !!Initiates(E(),F(),time).") == Strings{"E2301 11:10-32"});
  CHECK(CheckedText(std::string(kWorld) + "[time] {a} P(a) -> Initiates(D(a),G(a),time).")
            .text()
            .find("put parentheses around the condition") != std::string::npos);
}

TEST_CASE("mentions in conditions and definitions stay axioms over the completed effects") {
  CHECK(shapes("[event,time] Initiates(event,F(),time) -> !Happens(event,time).") ==
        Strings{"mentions: [event,time](Initiates(event,F(),time) -> !Happens(event,time))"});
  CHECK(shapes("[time] !Releases(E(),F(),time).") ==
        Strings{"mentions: [time]!Releases(E(),F(),time)"});
  CHECK(shapes("[time] Q() <-> ({event} Terminates(event,F(),time)).") ==
        Strings{"mentions: [time](Q() <-> {event}Terminates(event,F(),time))"});
}

TEST_CASE("trajectories are recorded like effects") {
  CHECK(shapes("[time,offset] HoldsAt(F(),time) -> Trajectory(F(),time,G(A),offset).") ==
        Strings{"[time,offset] HoldsAt(F(),time) => Trajectory(F(),time,G(A),offset)"});
  CHECK(shapes("[time,offset] AntiTrajectory(F(),time,G(A),offset).") ==
        Strings{"[time,offset] true => AntiTrajectory(F(),time,G(A),offset)"});
  CHECK(shapes("[time,offset] Trajectory(F(),time,G(A),offset) -> Q().") == Strings{"E2303"});
}

TEST_CASE(
    "effect constraints: the conditions of effect axioms may mention effects, and deny them") {
  CHECK(shapes("[event,time] Terminates(event,F(),time) -> Terminates(event,G(A),time).") ==
        Strings{"[event,time] Terminates(event,F(),time) => Terminates(event,G(A),time)"});
  CHECK(shapes("[time] !Initiates(E(),F(),time) & Q() -> Releases(E(),G(A),time).") ==
        Strings{"[time] (!Initiates(E(),F(),time) & Q()) => Releases(E(),G(A),time)"});
  CHECK(shapes("[event,time] Initiates(event,F(),time) -> Initiates(event,G(A),time) & Q().") ==
        Strings{"[event,time] Initiates(event,F(),time) => Initiates(event,G(A),time)",
                "mentions: [event,time](Initiates(event,F(),time) -> Q())"});
  CHECK(shapes("[time,offset] Initiates(E(),F(),time) -> Trajectory(F(),time,G(A),offset).") ==
        Strings{"[time,offset] Initiates(E(),F(),time) => Trajectory(F(),time,G(A),offset)"});
  CHECK(shapes("[time] (Initiates(E(),F(),time) -> Q()) -> P(A).") ==
        Strings{"mentions: [time]((Initiates(E(),F(),time) -> Q()) -> P(A))"});
  CHECK(warnings("[event,time] Terminates(event,F(),time) -> Terminates(event,G(A),time).") ==
        Strings{"W2001"});
}

TEST_CASE("predicates of other event calculi are refused with the way to rewrite them") {
  const auto says = [](const std::string& formula, const std::string& words) {
    const CheckedText checked(kWorld + formula);
    return !checked.model && checked.text().find(words) != std::string::npos;
  };
  CHECK(says("Happens3(E(),0,1).", "declare `predicate Happens3(event,time,time)`"));
  CHECK(says("Happens(E(),0,1).", "declare `predicate Happens3(event,time,time)`"));
  CHECK(says("!Clipped(0,F(),1).", "add `load foundations/DEC.e`"));
  CHECK(says("!StoppedIn(0,F(),1).", "DEC3 and DEC4 hold by themselves"));
  CHECK(says("[time] Started(F(),time) -> Q().", "add `load foundations/ECCausal.e`"));
}

TEST_CASE(
    "definitions of the foundations stay where the model uses them, those of ECCausal.e always") {
  const auto axioms = [](const std::string& text) {
    const CheckedText checked(text);
    REQUIRE_MESSAGE(checked.model, checked.text());
    return checked.model->axioms.size();
  };
  const std::string causal = "load foundations/ECCausal.e\nrange time 0 1\nfluent F()\nevent E()\n";
  CHECK(axioms(causal) == 4);
  CHECK(axioms(causal + "[time] Started(F(),time) -> Happens(E(),time).") == 5);
  CHECK(axioms(causal + "[time] Initiated(F(),time) -> Happens(E(),time).") == 5);
  CHECK(axioms("load foundations/EC.e\nrange time 0 1\nfluent F()\nevent E()\n") == 0);
  CHECK(axioms("option encoding 3\nload foundations/EC.e\nrange time 0 1\nfluent F()\n"
               "[time1,time2] Clipped(time1,F(),time2).") == 2);
}

TEST_CASE("a single formula: time may be free, fluents may stand for HoldsAt, effects may not") {
  CheckedText checked(kWorld);
  REQUIRE(checked.model);
  auto& model = *checked.model;
  const auto check = [&](const char* text, const compiler::FormulaOptions& options) {
    FrontEnd front;
    const auto file = front.add(text);
    const auto parsed = compiler::parse_formula(file, front.files, front.sink);
    REQUIRE(parsed);
    const auto result =
        compiler::check_formula(model, parsed->ast, parsed->root, options, front.sink);
    if (!result) return front.codes().at(0);
    return TypedText(model).formula(result->formula) + (result->time ? " @time" : "");
  };
  CHECK(check("HoldsAt(F(),time) & !HoldsAt(G(A),time+1)", {}) ==
        "(HoldsAt(F(),time) & !HoldsAt(G(A),(time+1))) @time");
  CHECK(check("HoldsAt(F(),2)", {}) == "HoldsAt(F(),2)");
  CHECK(check("[time] HoldsAt(F(),time)", {}) == "[time]HoldsAt(F(),time)");
  CHECK(check("HoldsAt(F(),time)", {.allow_free_time = false}) == "E2102");
  CHECK(check("HoldsAt(G(a),time)", {}) == "E2102");
  CHECK(check("F()", {}) == "E2106");
  CHECK(check("F() & !G(A)", {.fluents_as_atoms = true}) ==
        "(HoldsAt(F(),time) & !HoldsAt(G(A),time)) @time");
  CHECK(check("[a] G(a) -> P(a)", {.fluents_as_atoms = true}) ==
        "[a](HoldsAt(G(a),time) -> P(a)) @time");
  CHECK(check("E()", {.fluents_as_atoms = true}) == "E2106");
  CHECK(check("[time] Initiates(E(),F(),time)", {}) == "E2302");
  compiler::Term three;
  three.integer = 3;
  const auto at = model.terms.add(three);
  CHECK(check("F()", {.fluents_as_atoms = true, .fluent_time = at}) == "HoldsAt(F(),3)");
}

}  // namespace
}  // namespace parallax::test
