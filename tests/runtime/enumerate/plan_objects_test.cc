// Objects that only the model knows: detected, described, asked about.
#include <doctest/doctest.h>

#include "runtime/enumerate/plan_enumerator.h"
#include "tests/support/planned_model.h"

namespace parallax::test {
namespace {

using runtime::Exploration;

constexpr const char* kCups = R"(
sort cup
sort colour
cup c1, c2, c3
colour red, blue
predicate Is(cup,colour)
fluent Seen(cup)
fluent Held(cup)
event Look(colour)
event Grab(cup)
Is(c1,red).
Is(c2,red).
Is(c3,blue).
[cup,colour1,colour2] Is(cup,colour1) & Is(cup,colour2) -> colour1=colour2.
[cup,time] Initiates(Grab(cup),Held(cup),time).
[cup] !HoldsAt(Held(cup),0).
)";
constexpr const char* kCupBinding = R"(
motion detecting (:object type ?y) -> Look(?y) ok: exists c. Is(c,?y) & Seen(c) @t
    returns c ; else perception-object-not-found
action picking-up (:object ?o) -> Grab(?o) ok: Held(?o) @t+1
)";

TEST_CASE("any of the objects that a formula admits is returned, and each pick is a trace") {
  const std::string plan = R"(
(let ((?c (perform (a motion (type detecting) (object (an object (type red)))))))
  (perform (an action (type picking-up) (object ?c))))
)";
  PlannedModel model(std::string(kCups) + "[cup] HoldsAt(Seen(cup),0).\n", plan, kCupBinding,
                     "{cup} HoldsAt(Held(cup),time)", 3);
  REQUIRE(model.codes() == "");
  const auto found = model.keys();
  CHECK(found.keys == std::vector<std::string>{"Look(red)=c1;Grab(c1);", "Look(red)=c2;Grab(c2);"});
  CHECK(found.exploration == Exploration::kAllTracesExplored);
}

TEST_CASE("two objects known at once are kept apart, and compared") {
  const std::string plan = R"(
(defun look () (perform (a motion (type detecting) (object (an object (type red))))))
(let ((?a (look)) (?b (look)))
  (unless (eq ?a ?b)
    (perform (an action (type picking-up) (object ?b)))
    (when (eq ?a 'c1)
      (perform (an action (type picking-up) (object ?a))))))
)";
  PlannedModel model(std::string(kCups) + "[cup] HoldsAt(Seen(cup),0).\n", plan, kCupBinding,
                     "HoldsAt(Held(c1),time) & HoldsAt(Held(c2),time)", 6);
  REQUIRE(model.codes() == "");
  CHECK(model.keys().keys ==
        std::vector<std::string>{"Look(red)=c1;Look(red)=c2;Grab(c2);Grab(c1);"});
}

TEST_CASE("a result that the formula does not quantify over is refused") {
  const char* const binding =
      "motion detecting (:object type ?y) -> Look(?y) ok: Seen(c1) @t returns cup\n";
  PlannedModel model(kCups, "(perform (a motion (type detecting) (object (an object (type red)))))",
                     binding, "{cup} HoldsAt(Held(cup),time)", 2);
  CHECK(model.codes() == "E4001");
  const char* const unknown =
      "motion detecting (:object type ?y) -> Look(?y) ok: Seen(c1) @t returns x\n";
  PlannedModel other(kCups, "(perform (a motion (type detecting) (object (an object (type red)))))",
                     unknown, "{cup} HoldsAt(Held(cup),time)", 2);
  CHECK(other.codes() == "E4001");
}

constexpr const char* kReferences = R"(
object (:type ?y) ok: Is(?o,?y) & Seen(?o) @t  returns ?o
query anything-held () ok: {cup} Held(cup) @t
query held (?o) ok: Held(?o) @t
)";

TEST_CASE("an object that is only described is any one that fits, each a trace") {
  const std::string plan =
      "(perform (an action (type picking-up) (object (an object (type red)))))";
  const auto binding = std::string(kCupBinding) + kReferences;
  PlannedModel all(std::string(kCups) + "[cup] HoldsAt(Seen(cup),0).\n", plan, binding,
                   "{cup} HoldsAt(Held(cup),time)", 3);
  REQUIRE(all.codes() == "");
  auto found = all.keys();
  CHECK(found.keys == std::vector<std::string>{"Grab(c1);", "Grab(c2);"});
  CHECK(found.exploration == Exploration::kAllTracesExplored);
  PlannedModel one(std::string(kCups) + "[cup] HoldsAt(Seen(cup),0) <-> cup=c2.\n", plan, binding,
                   "{cup} HoldsAt(Held(cup),time)", 3);
  CHECK(one.keys().keys == std::vector<std::string>{"Grab(c2);"});
}

TEST_CASE("a description that nothing fits fails, and the plan can handle that") {
  const std::string plan = R"(
(with-failure-handling
    ((designator-reference-failure (e)
       (perform (an action (type picking-up) (object (an object (name c3)))))
       (return)))
  (perform (an action (type picking-up) (object (an object (type red))))))
)";
  PlannedModel model(std::string(kCups) + "[cup] !HoldsAt(Seen(cup),0).\n", plan,
                     std::string(kCupBinding) + kReferences, "{cup} HoldsAt(Held(cup),time)", 3);
  REQUIRE(model.codes() == "");
  CHECK(model.keys().keys == std::vector<std::string>{"Grab(c3);"});
  // One that tries again for ever, at one timepoint, is cut and named.
  PlannedModel endless(std::string(kCups) + "[cup] !HoldsAt(Seen(cup),0).\n", R"(
(with-failure-handling ((designator-reference-failure (e) (retry)))
  (perform (an action (type picking-up) (object (an object (type red))))))
)",
                       std::string(kCupBinding) + kReferences, "{cup} HoldsAt(Held(cup),time)", 3);
  REQUIRE(endless.codes() == "");
  const auto found = endless.keys();
  CHECK(found.keys.empty());
  CHECK(found.exploration == Exploration::kCompleteUpToBound);
  REQUIRE(found.open_ends.cuts.size() == 1);
  CHECK(endless.compiled().plan_cuts[0].form == "perform");
}

TEST_CASE("queries ask the model, through prolog and through holds") {
  const std::string plan = R"(
(unless (prolog '(anything-held))
  (perform (an action (type picking-up) (object (an object (name c3))))))
(when (cram-occasions-events:holds '(held c1))
  (perform (an action (type picking-up) (object (an object (name c2))))))
)";
  std::string cups = kCups;
  cups.resize(cups.rfind("[cup] !HoldsAt(Held(cup),0)"));  // c1 may be held from the start
  PlannedModel model(cups + "!HoldsAt(Held(c2),0).\n!HoldsAt(Held(c3),0).\n", plan,
                     std::string(kCupBinding) + kReferences,
                     "HoldsAt(Held(c2),time) | HoldsAt(Held(c3),time)", 4);
  REQUIRE(model.codes() == "");
  CHECK(model.keys().keys == std::vector<std::string>{"Grab(c2);", "Grab(c3);"});
}

}  // namespace
}  // namespace parallax::test
