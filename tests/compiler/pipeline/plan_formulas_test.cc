// Formulas of the binding table in the model: names that a plan, a binding and a model share.

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/support/planned_model.h"

namespace parallax::test {
namespace {

using Strings = std::vector<std::string>;

// The cup is seen, the base of x is there; y has none.
constexpr const char* kThings =
    "range time 0 1\n"
    "sort thing\n"
    "thing x, y, cup, mug\n"
    "sort stand\n"
    "stand s, u\n"
    "fluent Seen(thing)\n"
    "fluent Base(thing)\n"
    "fluent Stands(stand)\n"
    "event Look(thing)\n"
    "event Turn(stand)\n"
    "[thing,time] HoldsAt(Seen(thing),time) <-> thing=cup.\n"
    "[thing,time] HoldsAt(Base(thing),time) <-> thing=x | thing=mug.\n"
    "[stand,time] HoldsAt(Stands(stand),time) <-> stand=s.\n"
    "Delta: [thing,time] Happens(Look(thing),time) -> time=0.\n";

/// The outcomes of one perform: "ok", "failed", or the codes that were reported.
std::string outcome(const std::string& kind, const std::string& object,
                    const std::string& binding) {
  const auto plan = "(perform (a motion (type " + kind + ") (object (an object (name " + object +
                    ")))))\n(perform (a motion (type ending)))";
  const PlannedModel model(std::string(kThings) +
                               "event End()\nfluent Over()\n"
                               "[time] Initiates(End(),Over(),time).\n!HoldsAt(Over(),0).\n",
                           plan, binding + "\nmotion ending -> End() ok: Over() @t+1",
                           "Happens(End(),time-1)", 2);
  if (!model.compiles()) return model.codes();
  return model.keys().keys.empty() ? "failed" : "ok";
}

std::string looking(const std::string& object, const std::string& formula) {
  return outcome("looking", object,
                 "motion looking (:object name ?o) -> Look(?o) ok: " + formula + " @t");
}
std::string turning(const std::string& object, const std::string& formula) {
  return outcome("turning", object,
                 "motion turning (:object name ?o) -> Turn(?o) ok: " + formula + " @t");
}

TEST_CASE("a constant of the plan is not captured by a quantifier of the binding") {
  for (const auto* variable : {"x", "y", "z", "cup", "mug", "thing2", "i"}) {
    CAPTURE(variable);
    const std::string v = variable;
    const auto formula = "exists " + v + ". Seen(" + v + ") & Base(?o)";
    CHECK(looking("x", formula) == "ok");
    CHECK(looking("mug", formula) == "ok");
    CHECK(looking("y", formula) == "failed");
    CHECK(looking("cup", formula) == "failed");
    CHECK(looking("x", "forall " + v + ". (Seen(" + v + ") -> !Base(" + v + ")) & Base(?o)") ==
          "ok");
    CHECK(looking("x", "Base(?o) & exists " + v + ". Base(" + v + ") & Base(?o)") == "ok");
  }
  CHECK(looking("mug", "{thing1} Seen(thing1) & Base(?o)") == "ok");
  CHECK(looking("cup", "{thing1} Base(thing1) & Seen(?o)") == "ok");
  CHECK(looking("cup", "{thing1} Base(thing1) & Seen(thing1)") == "failed");
}

TEST_CASE("a constant may have the name of a variable of another sort") {
  for (const auto* variable : {"s", "u", "i"}) {
    CAPTURE(variable);
    const std::string v = variable;
    CHECK(turning("s", "exists " + v + ". Seen(" + v + ") & Stands(?o)") == "ok");
    CHECK(turning("u", "exists " + v + ". Seen(" + v + ") & Stands(?o)") == "failed");
  }
}

TEST_CASE("two quantifiers of one name are two variables, each of its own sort") {
  CHECK(looking("x", "(exists i. Seen(i)) & (exists i. Stands(i)) & Base(?o)") == "ok");
  CHECK(looking("x", "exists i. Seen(i) & (exists i. Base(i) & !Seen(i)) & Seen(i)") == "ok");
  CHECK(looking("x", "exists i. Stands(i) & exists i. Seen(i)") == "ok");
}

TEST_CASE("a quantified `region` does not repeat the event's") {
  const std::string model =
      "sort region\nregion a1, b2\nfluent In(region)\nevent Go(region)\n"
      "[time] {region} HoldsAt(In(region),time).\n"
      "[region1,region2,time] HoldsAt(In(region1),time) & HoldsAt(In(region2),time) -> "
      "region1=region2.\n"
      "HoldsAt(In(a1),0).\n[region,time] Happens(Go(region),time) -> time=0.\n";
  const std::string plan =
      "(perform (a motion (type going) (target (make-pose-stamped \"map\" 0.0 (make-3d-vector 1.5 "
      "0 0) (make-identity-rotation)))))";
  const auto traces = [&](const std::string& formula) {
    const PlannedModel planned(model, plan,
                               "motion going (:target ?p) -> Go(region(?p)) ok: " + formula +
                                   " @t+1 else navigation-pose-unreachable",
                               "Happens(Go(b2),time-1)", 1);
    REQUIRE(planned.compiles());
    return planned.keys().keys;
  };
  // The robot stays in a1: somewhere it is, but not where it went.
  CHECK(traces("{region} In(region)") == traces("In(a1)"));
  CHECK(traces("In(region)") == traces("In(b2)"));
}

TEST_CASE("a variable without a sort and a wrong atom are reported at the binding's formula") {
  CHECK(looking("x", "exists q. 1 < 2") == "E2103");
  CHECK(looking("x", "Base(?o,?o)").starts_with("E21"));
  CHECK(looking("x", "Nothing(?o)") == "E2101");
  CHECK(looking("x", "Base(?o)) & (Seen(?o)") == "E1006");
  CHECK(looking("x", "Base(?o).") == "ok");
}

}  // namespace
}  // namespace parallax::test
