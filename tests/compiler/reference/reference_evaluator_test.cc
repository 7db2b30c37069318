#include "compiler/reference/reference_evaluator.h"

#include <doctest/doctest.h>

#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

using compiler::ReferenceEvaluator;
using compiler::ReferenceLimits;
using compiler::Valuation;

/// A model, its evaluator, and valuations written as "F() G(a)|F()|" with one part per timepoint.
class Evaluated {
 public:
  explicit Evaluated(const std::string& text, const ReferenceLimits& limits = {}) : model_(text) {
    CAPTURE(model_.text());
    REQUIRE(model_.model.has_value());
    evaluator_.emplace(*model_.model, limits);
  }
  const ReferenceEvaluator& evaluator() const { return *evaluator_; }

  static Valuation valuation(const std::string& holds, const std::string& happens,
                             const std::string& released = "", const std::string& predicates = "") {
    Valuation v;
    v.holds = parts(holds);
    v.happens = parts(happens);
    v.happens.resize(v.holds.size());
    v.released = parts(released);
    v.released.resize(v.holds.size());
    v.predicates = parts(predicates).front();
    return v;
  }
  /// The texts of all violations, one per line.
  std::string wrong(const Valuation& v) const {
    std::string out;
    for (const auto& violation : evaluator_->violations(v, 100).violations) {
      out += violation.text + '\n';
    }
    return out;
  }
  std::string source(const compiler::Violation& violation) const {
    return std::string(model_.files.text(violation.source));
  }

 private:
  static std::vector<std::set<std::string>> parts(const std::string& text) {
    std::vector<std::set<std::string>> out(1);
    std::string word;
    for (const char c : text + ' ') {
      if (c != ' ' && c != '|') {
        word += c;
        continue;
      }
      if (!word.empty()) out.back().insert(word);
      word.clear();
      if (c == '|') out.emplace_back();
    }
    return out;
  }

  CheckedText model_;
  std::optional<ReferenceEvaluator> evaluator_;
};

const char* const kLamp =
    "range time 0 2\nfluent Lit()\nfluent Hot()\nevent On()\nevent Off()\nevent Kick()\n"
    "[time] Initiates(On(),Lit(),time).\n[time] Terminates(Off(),Lit(),time).\n"
    "[time] Releases(Kick(),Hot(),time).\n[time] Initiates(On(),Hot(),time).\n";

TEST_CASE("a fluent that changes without an event breaks DEC5 or DEC6") {
  const Evaluated lamp(kLamp);
  CHECK(lamp.wrong(lamp.valuation("Lit()|Lit()|Lit()", "")) == "");
  CHECK(lamp.wrong(lamp.valuation("Lit()|Lit()|", "")) ==
        "DEC5 for Lit(): it changes without an event at 1\n");
  CHECK(lamp.wrong(lamp.valuation("|Lit()|Lit()", "")) ==
        "DEC6 for Lit(): it changes without an event at 0\n");
  const auto found = lamp.evaluator().check(lamp.valuation("|Lit()|Lit()", ""));
  REQUIRE(found.has_value());
  CHECK(found->what == "DEC6 for Lit()");
  CHECK(found->timepoint == 0);
  CHECK(lamp.source(*found) == "Lit()");
}

TEST_CASE("a release that comes or goes without an event breaks DEC7 or DEC8") {
  const Evaluated lamp(kLamp);
  CHECK(lamp.wrong(lamp.valuation("||", "Kick()", "|Hot()|Hot()")) == "");
  CHECK(lamp.wrong(lamp.valuation("||", "Kick()", "|Hot()|")) ==
        "DEC7 for Hot(): its release changes without an event at 1\n");
  CHECK(lamp.wrong(lamp.valuation("||", "", "||Lit()")) ==
        "DEC8 for Lit(): its release changes without an event at 1\n");
  CHECK(lamp.wrong(lamp.valuation("||", "", "Hot()|Hot()|Hot()")) ==
        "released at the start: Hot()\n");
}

TEST_CASE("an effect that does not come breaks DEC9 to DEC12, at its effect axiom") {
  const Evaluated lamp(kLamp);
  CHECK(lamp.wrong(lamp.valuation("|Lit() Hot()|Lit() Hot()", "On()")) == "");
  CHECK(lamp.wrong(lamp.valuation("|Hot()|Hot()", "On()")) ==
        "DEC9 for Lit(): no effect of Happens(On(),0)\n");
  CHECK(lamp.wrong(lamp.valuation("Lit()|Lit()|Lit()", "|Off()")) ==
        "DEC10 for Lit(): no effect of Happens(Off(),1)\n");
  CHECK(lamp.wrong(lamp.valuation("||", "|Kick()")) ==
        "DEC11 for Hot(): no effect of Happens(Kick(),1)\n");
  const auto both = lamp.valuation("|Lit() Hot()|Lit() Hot()", "On() Kick()", "|Hot()|Hot()");
  CHECK(lamp.wrong(both) == "DEC12 for Hot(): no effect of Happens(On(),0)\n");
  const auto found = lamp.evaluator().check(both);
  REQUIRE(found.has_value());
  CHECK(lamp.source(*found) == "[time] Initiates(On(),Hot(),time)");
}

TEST_CASE("an axiom is quoted with the atoms of the instance that is false") {
  const Evaluated model(
      "range time 0 2\nsort room\nroom A, B\nfluent In(room)\nnoninertial In\n"
      "[room1,room2,time] HoldsAt(In(room1),time) & HoldsAt(In(room2),time) -> room1=room2.\n");
  const std::string released = "In(A) In(B)|In(A) In(B)|In(A) In(B)";
  CHECK(model.wrong(model.valuation("In(A)|In(B)|", "", released)) == "");
  CHECK(model.wrong(model.valuation("In(A)|In(A) In(B)|", "", released)) ==
        "axiom: HoldsAt(In(A),1) is true, HoldsAt(In(B),1) is true\n"
        "axiom: HoldsAt(In(A),1) is true, HoldsAt(In(B),1) is true\n");
  CHECK(model.wrong(model.valuation("||", "", "In(A) In(B)|In(A) In(B)|In(B)")) ==
        "noninertial In(A): not released at 2\n");
}

TEST_CASE("a completed atom without a reason") {
  const Evaluated model(
      "range time 0 2\nfluent F()\nevent E()\nevent D()\nDelta: Happens(E(),0).\n"
      "Delta: [time] HoldsAt(F(),time) -> Happens(D(),time).\n"
      "[time] Happens(D(),time) -> Happens(E(),0).\ncompletion Delta Happens\n");
  CHECK(model.wrong(model.valuation("||", "E()")) == "");
  CHECK(model.wrong(model.valuation("||", "E()|D()")) ==
        "completion of Happens(D(),1): no reason\n");
  CHECK(model.wrong(model.valuation("F()|F()|F()", "E() D()|D()")) == "");
  const auto found = model.evaluator().check(model.valuation("||", "E()|D()"));
  REQUIRE(found.has_value());
  CHECK(model.source(*found).starts_with("completion"));
}

TEST_CASE("a completed predicate that no formula mentions has no true atom") {
  const Evaluated model("range time 0 0\nsort thing\nthing A\npredicate P(thing)\ncompletion P\n");
  CHECK(model.wrong(model.valuation("", "")) == "");
  CHECK(model.wrong(model.valuation("", "", "", "P(A)")) == "completion of P(A): no reason\n");
}

TEST_CASE("a trajectory that is not followed, and one that was stopped in time") {
  const Evaluated model(
      "range time 0 3\nrange offset 1 3\nfluent On()\nfluent Up()\nnoninertial Up\n"
      "event Go()\nevent Halt()\n[time] Initiates(Go(),On(),time).\n"
      "[time] Terminates(Halt(),On(),time).\n[time] Trajectory(On(),time,Up(),2).\n");
  const std::string released = "Up()|Up()|Up()|Up()";
  CHECK(model.wrong(model.valuation("|On()|On() Up()|On()", "Go()", released)) == "");
  CHECK(model.wrong(model.valuation("|On()|On()|On()", "Go()", released)) ==
        "DEC3 for On(): since 0 it leads to HoldsAt(Up(),2)\n");
  CHECK(model.wrong(model.valuation("|On()||", "Go()|Halt()", released)) == "");
  CHECK(model.wrong(model.valuation("|On()|On()|", "Go()||Halt()", released)) ==
        "DEC3 for On(): since 0 it leads to HoldsAt(Up(),2)\n");
}

TEST_CASE("an instance exists only if all its atoms and comparisons do") {
  // At 2 nothing is said: there is no time+1.
  const Evaluated model(
      "range time 0 2\nfluent F()\nnoninertial F\n"
      "[time] time=2 & HoldsAt(F(),time+1) | !(time=2) & HoldsAt(F(),time).\n");
  CHECK(model.wrong(model.valuation("F()|F()|", "", "F()|F()|F()")) == "");
  CHECK(model.evaluator().silent_axioms().empty());
  const Evaluated silent("range time 0 0\nfluent F()\n[time] HoldsAt(F(),time+1) | time=0.\n");
  CHECK(silent.evaluator().silent_axioms().size() == 1);
}

TEST_CASE("a division by zero and an overflow do not denote") {
  const Evaluated model(
      "range time 0 0\nsort num: integer\nrange num 0 2\nfluent F(num)\n"
      "[num] 4/num=2 -> HoldsAt(F(num),0).\n"
      "[num] 9223372036854775807+num>0 -> HoldsAt(F(num+1),0).\n");
  CHECK(model.wrong(model.valuation("F(1) F(2)", "")) == "");
  CHECK(model.wrong(model.valuation("F(2)", "")) == "axiom: HoldsAt(F(1),0) is false\n");
}

TEST_CASE("a trace that is shorter than the horizon is held to what concerns it") {
  const Evaluated model(
      "range time 0 3\nfluent F()\nevent E()\n[time] Terminates(E(),F(),time).\nHoldsAt(F(),0).\n"
      "!HoldsAt(F(),3).\n[time] HoldsAt(F(),time+1) -> !Happens(E(),time).\n"
      "[time] !HoldsAt(F(),time+1) -> Happens(E(),time).\ncompletion Happens\n");
  CHECK(model.wrong(model.valuation("F()|F()", "")) == "");
  CHECK(model.wrong(model.valuation("F()|", "E()")) == "");
  CHECK(model.wrong(model.valuation("F()|F()", "E()")) ==
        "axiom: Happens(E(),0) is true, HoldsAt(F(),1) is true\n"
        "DEC10 for F(): no effect of Happens(E(),0)\n"
        "completion of Happens(E(),0): no reason\n");
  CHECK(model.wrong(model.valuation("F()|F()|F()|F()", "")) == "axiom: HoldsAt(F(),3) is true\n");
}

TEST_CASE("atoms that the model does not have are named") {
  const Evaluated model("range time 0 1\nfluent F()\nevent E()\n");
  CHECK(model.wrong(model.valuation("G()|", "|E()", "", "P(a)")) ==
        "there is no HoldsAt(G(),0)\nthere is no Happens(E(),1)\nthere is no P(a)\n");
  CHECK(model.wrong(model.valuation("||", "")) == "the trace ends at 2, the model at 1\n");
}

TEST_CASE("a model beyond the budget is refused, and so is one that nests too deep") {
  ReferenceLimits limits;
  limits.max_instances = 1000;
  const std::string product =
      "range time 0 40\nfluent F()\nevent E()\n"
      "[time1,time2,time3] HoldsAt(F(),time1) | HoldsAt(F(),time2) | HoldsAt(F(),time3).\n";
  const Evaluated large(product, limits);
  REQUIRE(large.evaluator().refusal().has_value());
  CHECK(*large.evaluator().refusal() == "the model has more than 1000 ground terms and instances");
  CHECK(!Evaluated(product).evaluator().refusal());

  CHECK(Evaluated("range time 0 2000000000\nfluent F()\nevent E()\n").evaluator().refusal());
  const Evaluated deep("range time 0 1\nfluent F()\n" + std::string(15'000, '!') +
                       "HoldsAt(F(),0).\n");
  REQUIRE(deep.evaluator().refusal().has_value());
  CHECK(*deep.evaluator().refusal() == "its formulas nest too deep");
}

TEST_CASE("a check that looks for reasons without end gives up") {
  ReferenceLimits limits;
  limits.max_reasons = 10;
  const Evaluated model(
      "range time 0 4\nevent E()\nevent D()\n{time} Happens(E(),time) | Happens(D(),time).\n"
      "[time] Happens(E(),time) -> Happens(D(),time).\ncompletion Happens\n",
      limits);
  const auto report =
      model.evaluator().violations(model.valuation("||||", "E() D()|E() D()|E() D()|E() D()"), 100);
  CHECK(!report.finished);
}

}  // namespace
}  // namespace parallax::test
