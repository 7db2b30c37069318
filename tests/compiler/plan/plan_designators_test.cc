#include <doctest/doctest.h>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

/// Expressions and their expected values.
void check_equal(const std::vector<std::pair<std::string, std::string>>& cases) {
  for (const auto& one : cases) {
    const auto& expression = one.first;
    CAPTURE(expression);
    const auto plan = with_prelude(
        "(let* ((d '(desig-equal)) (cup (an object (type cup) (size 2))))"
        "(if (equal " +
        expression + " " + one.second + ") (go1) (go2)))");
    CHECK(plan.events("+") == Strings{"Go(r1)", "DONE"});
  }
}

TEST_CASE("designators: properties") {
  check_equal({
      {"(desig:desig-prop-value cup :type)", ":cup"},
      {"(desig:desig-prop-value cup 'size)", "2"},
      {"(desig:desig-prop-value cup :colour)", "nil"},
      {"(desig:desig-prop-value nil :colour)", "nil"},
      {"(desig:properties cup)", "'((:type :cup) (:size 2))"},
      {"(desig:description (an action (type x) (when nil (y 1))))", "'((:type :x))"},
      {"(desig:desig-prop-values (an object (a 1) (b 2) (a 3)) :a)", "'(1 3)"},
      {"(properties (make-designator :object '((:type :cup))))", "'((:type :cup))"},
      {"(properties (make-designator 'desig-props:location `((:on ,(1+ 1)))))", "'((:on 2))"},
      {"(properties (copy-designator cup))", "'((:size 2) (:type :cup))"},
      {"(properties (copy-designator cup :new-description '((:size 3) (:colour :red))))",
       "'((:type :cup) (:size 3) (:colour :red))"},
      {"(properties (extend-designator-properties cup '((:size 3))))",
       "'((:type :cup) (:size 2) (:size 3))"},
      {"(update-designator-properties '((:a 1)) '((:b 2) (:a 3)))", "'((:a 1) (:b 2))"},
      {"(get-desig-class cup)", ":object"},
      {"(with-desig-props (type colour) cup (list type colour))", "'(:cup nil)"},
      {"(with-designators ((x :object '((:type :cup))) (y :location `((:of ,x)))) "
       "(desig-prop-value (desig-prop-value y :of) :type))",
       ":cup"},
  });
}

TEST_CASE("designators: classes") {
  check_equal({
      {"(typep cup 'desig:object-designator)", "t"},
      {"(typep cup 'desig:location-designator)", "nil"},
      {"(typep cup 'desig:designator)", "t"},
      {"(typep :cup 'desig:designator)", "nil"},
      {"(typep (a motion (type going)) 'motion-designator)", "t"},
      {"(object-designator-p cup)", "t"},
      {"(action-designator-p cup)", "nil"},
      {"(location-designator-p 5)", "nil"},
      {"(designatorp (make-designator :action nil))", "t"},
  });
}

TEST_CASE("designators: equating") {
  check_equal({
      {"(desig-equal cup cup)", "t"},
      {"(desig-equal cup (an object (type cup) (size 2)))", "nil"},
      {"(desig-equal cup 5)", "nil"},
      {"(eq cup (current-desig cup))", "t"},
      {"(current-desig nil)", "nil"},
      {"(let ((new (an object (type mug)))) (eq new (equate cup new)))", "t"},
      {"(let ((new (an object (type mug)))) (equate cup new) (eq new (current-desig cup)))", "t"},
      {"(let ((new (an object (type mug)))) (equate cup new) (eq cup (first-desig new)))", "t"},
      {"(let ((new (an object (type mug)))) (equate cup new) (desig-equal cup new))", "t"},
      {"(let ((new (make-designator :object '((:type :mug)) cup))) (desig-equal cup new))", "t"},
      // The youngest is asked for, whichever of them it is that was equated.
      {"(let ((b (an object (n 1))) (c (an object (n 2)))) (equate cup b) (equate cup c) "
       "(list (eq c (current-desig b)) (eq c (newest-effective-designator cup))))",
       "'(t t)"},
      // A designator that is equated with a successor comes before it in the chain.
      {"(let ((b (an object (n 1))) (c (an object (n 2)))) (equate cup b) (equate c b) "
       "(list (eq b (current-desig c)) (desig-equal cup c)))",
       "'(t t)"},
      {"(handler-case (equate cup cup) (error (e) 'twice))", "'twice"},
  });
}

TEST_CASE("designators: locations refer to their pose") {
  const auto plan = with_prelude(R"(
(let* ((?inner (a location (pose *p1*)))
       (?pose (reference (a location (location ?inner)))))
  (perform (a motion (type going) (target ?pose)))))");
  CHECK(plan.events("+") == Strings{"Go(r1)", "DONE"});
}

TEST_CASE("designators: a description that was equated with what was detected means it") {
  const auto plan = with_prelude(R"(
(let* ((?first (an object (type cup)))
       (?second (an object (type cup)))
       (?seen (perform (a motion (type detecting) (object ?first)))))
  (equate ?first ?seen)
  (perform (an action (type picking-up) (arm left) (object ?first)))
  (when (eq (desig-prop-value (current-desig ?first) :type) :cup)
    (perform (a motion (type detecting) (object ?second))))))");
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("+++") == Strings{"Detect(cup)", "PickUp(left,?i1)", "Detect(cup)", "DONE"});
}

TEST_CASE("designators: what was detected can be sought again, as often as one likes") {
  const auto plan = with_prelude(R"(
(let ((?cup (an object (type cup))))
  (dotimes (i 4)
    (let ((?seen (perform (a motion (type detecting) (object ?cup)))))
      (unless (desig-equal ?cup ?seen) (equate ?cup ?seen))))))");
  CHECK(plan.events("++++") ==
        Strings{"Detect(cup)", "Detect(cup)", "Detect(cup)", "Detect(cup)", "DONE"});
}

TEST_CASE("designators: what is forgotten leaves no trace in the state") {
  // Each round makes and equates new designators; the second state is the first one again.
  const auto plan = with_prelude(R"(
(loop
  (let* ((?cup (an object (type cup)))
         (?seen (perform (a motion (type detecting) (object ?cup)))))
    (equate ?cup ?seen)
    (perform (an action (type picking-up) (arm left) (object ?cup))))))");
  CHECK(plan.graph->locations.size() == 2);
  CHECK(plan.walk("++") == "L0 L1 L0");
}

TEST_CASE("designators: plans that equate nothing are as they were") {
  const auto plan = with_prelude(R"(
(if (eq (an object (type cup)) (an object (type cup))) (go1) (go2)))");
  CHECK(plan.events("+") == Strings{"Go(r1)", "DONE"});
}

TEST_CASE("designators: what is no designator is said so") {
  for (const std::string form :
       {"(equate 1 2)", "(properties 5)", "(current-desig 'x)", "(make-designator :thing nil)",
        "(make-designator :object '(1))", "(copy-designator 5)", "(var-value 1 nil)",
        "(extend-designator-properties 5 nil)"}) {
    CAPTURE(form);
    CHECK(unroll(form).codes() == Strings{"CPL008"});
  }
}

}  // namespace
}  // namespace parallax::compiler
