#include <doctest/doctest.h>

#include "tests/compiler/plan/plan_fixture.h"
#include "tests/compiler/plan/value_checks.h"

namespace parallax::compiler {
namespace {

TEST_CASE("forms: arithmetic and lists") {
  check_values({
      {"(+ 1/3 1/6 0.5)", "1.0"},
      {"(- 5)", "-5"},
      {"(/ 1 3)", "1/3"},
      {"(* 2 (max 1 3 2) (min 4 2) (abs -1))", "12"},
      {"(1- (1+ 0.5))", "0.5"},
      {"(< 1 2 3)", "t"},
      {"(< 1 3 3)", "nil"},
      {"(/= 1 2 1)", "nil"},
      {"(list 1 \"a\" :b)", "(1 \"a\" :b)"},
      {"(append '(a) nil (list 'b (car '(c d))))", "(a b c)"},
      {"(reverse (cons 1 (cdr '(9 2 3))))", "(3 2 1)"},
      {"(cdr '(a . b))", "b"},
      {"(cdr (assoc 'b '((a . 1) (b . 2))))", "2"},
      {"(cons 'a 'b)", "(a . b)"},
      {"(append '(a) 'b)", "(a . b)"},
      {"`(a ,(+ 1 1) . ,(list 3))", "(a 2 3)"},
      {"`(a . ,(+ 1 1))", "(a . 2)"},
      {"(nth 1 '(a b))", "b"},
      {"(fifth '(1 2))", "nil"},
      {"(last '(1 2))", "(2)"},
      {"(length '(1 2))", "2"},
      {"(member 'b '(a b c) :test #'eq)", "(b c)"},
      {"(member :b '(a b c))", "nil"},
      {"(find 'x '(a b c))", "nil"},
      {"(remove 'a '(a b a))", "(b)"},
      {"(assoc 'k '((j 1) (k 2)))", "(k 2)"},
      {"`(a ,(+ 1 1) ,@(list 'b 'c) (d ,:e))", "(a 2 b c (d :e))"},
      {"(eq :left 'left)", "nil"},
      {"(eql 1 1.0)", "nil"},
      {"(equal 0.5 1/2)", "nil"},
      {"(= 0.5 1/2)", "t"},
      {"(list (cadr '(1 2)) (caddr '(1 2 3)))", "(2 3)"},
      {"(apply #'+ 1 2 '(3 4))", "10"},
      {"(apply #'list nil)", "nil"},
      {"(apply (lambda (a b) (list b a)) '(1 2))", "(2 1)"},
      {"(let ((n 1)) (flet ((add (x) (+ n x))) (apply #'add '(2))))", "3"},
  });
}

TEST_CASE("forms: conditions and local control") {
  check_values({
      {"(cond (nil 1) ((= 1 2) 2) ((list 3)) (t 4))", "(3)"},
      {"(cond (nil 1))", "nil"},
      {"(case 'b (a 1) ((b c) 2) (t 3))", "2"},
      {"(case :b (a 1) ((b c) 2) (t 3))", "3"},
      {"(case nil (nil 1) (t 2))", "2"},
      {"(case nil ((nil) 1) (t 2))", "1"},
      {"(print :x)", ":x"},
      {"(format nil \"x\")", "\"x\""},
      {"(multiple-value-bind (a b c) (values 1 2) (list a b c))", "(1 2 nil)"},
      {"(list (values 1 2) (values))", "(1 nil)"},
      {"(handler-case (fail 'object-unfetchable) (low-level-failure (e) 1) (plan-failure () 2))",
       "2"},
      {"(handler-case (ecase 1 (2 3)) (plan-failure (e) 1) (error () 2))", "2"},
      {"(handler-case (list 1) (plan-failure (e) 2))", "(1)"},
      {"(case 7 (a 1) (otherwise 3))", "3"},
      {"(ecase 'a (a 1))", "1"},
      {"(and 1 2 nil (fail 'plan-failure))", "nil"},
      {"(or nil 2 (fail 'plan-failure))", "2"},
      {"(when t 1 2)", "2"},
      {"(unless t 1)", "nil"},
      {"(block out (list 1 (return-from out 5)))", "5"},
      {"(let ((x 1) (y 2)) (setf x (+ x y) y 10) (list x y))", "(3 10)"},
      {"(let ((x 1)) (let ((x 2) (y x)) (list x y)))", "(2 1)"},
      {"(let* ((x 1) (y (+ x 1))) (incf y 2) (decf x) (list x y))", "(0 4)"},
      {"(let ((l nil)) (push 1 l) (push 2 l) l)", "(2 1)"},
      {"(destructuring-bind (a (b c)) '(1 (2 3)) (list c b a))", "(3 2 1)"},
      {"(progn (top-level (with-tags 1)) (seq 1 2))", "2"},
  });
}

TEST_CASE("forms: loops over static values") {
  check_values({
      {"(let ((s 0)) (dolist (x '(1 2 3) s) (incf s x)))", "6"},
      {"(dolist (x '(1 2)) (when (= x 2) (return 'found)))", "found"},
      {"(let ((s nil)) (dotimes (i 3 s) (push i s)))", "(2 1 0)"},
      {"(loop for x in '(1 2) for i from 10 collect (list x i))", "((1 10) (2 11))"},
      {"(loop for i from 1 to 5 by 2 collect i)", "(1 3 5)"},
      {"(loop for i from 2 downto 0 collect i)", "(2 1 0)"},
      {"(loop for i below 2 collect i)", "(0 1)"},
      {"(loop repeat 2 collect 'x)", "(x x)"},
      {"(let ((n 0)) (loop while (< n 4) do (incf n)) n)", "4"},
      {"(let ((n 0)) (loop (incf n) (when (> n 2) (return n))))", "3"},
      {"(let ((n 0)) (loop until (= n 3) do (incf n) (list n)) n)", "3"},
      {"(mapcar (lambda (x) (* x x)) '(1 2 3))", "(1 4 9)"},
      {"(let ((s 0)) (mapc (lambda (x) (setf s (+ s x))) '(1 2)) s)", "3"},
      {"(mapcar #'car '((a) (b)))", "(a b)"},
      {"(every #'numberp '(1 2))", "t"},
      {"(some (lambda (x) (and (> x 1) x)) '(1 2 3))", "2"},
      {"(some #'stringp '(1 2))", "nil"},
      {"(destructuring-bind (x) (mapcar (lambda (x) (mapcar #'1+ x)) '((1 2))) x)", "(2 3)"},
  });
}

TEST_CASE("forms: functions, keyword arguments and local functions") {
  const std::string defined = R"(
(defun add (a &optional (b 10)) (+ a b))
(defun key (a &key (b 1) c) (list a b c))
(defun early (x) (when x (return-from early 'out)) 'in)
(defun others (a &rest more) (list a more))
(defun computed (a &key (b (+ a 1)) (c nil given)) (list a b c given))
(defun free (&key (k :a) &allow-other-keys) k)
)";
  check_values({
      {"(flet ((f (x) (+ x 1))) (f (f 1)))", "3"},
      {"(let ((y 5)) (flet ((f (x) (setf y (+ x y)))) (f 1) (f 2) y))", "8"},
      {"(labels ((down (n) (if (= n 0) 'end (down (- n 1))))) (down 3))", "end"},
      {"(funcall #'+ 1 2)", "3"},
      {"(funcall (lambda (x &optional (y 2)) (list x y)) 1)", "(1 2)"},
      {"(let ((x 1)) (mapcar (lambda (y) (flet ((g () (+ x y))) (g))) '(1 2)))", "(2 3)"},
  });
  for (const auto& one :
       std::vector<std::pair<std::string, std::string>>{{"(add 1)", "11"},
                                                        {"(add 1 2)", "3"},
                                                        {"(key 1 :c 3)", "(1 1 3)"},
                                                        {"(key 1 :c 3 :b 2)", "(1 2 3)"},
                                                        {"(others 1)", "(1 nil)"},
                                                        {"(others 1 2 3)", "(1 (2 3))"},
                                                        {"(funcall #'others 1 2)", "(1 (2))"},
                                                        {"(mapcar #'others '(1))", "((1 nil))"},
                                                        {"(computed 1)", "(1 2 nil nil)"},
                                                        {"(computed 1 :c nil)", "(1 2 nil t)"},
                                                        {"(computed 1 :b 5)", "(1 5 nil nil)"},
                                                        {"(free :j 1)", ":a"},
                                                        {"(free :j 1 :k 2)", "2"},
                                                        {"(early t)", "out"},
                                                        {"(early nil)", "in"}}) {
    const auto& expression = one.first;
    const auto& wanted = one.second;
    CAPTURE(expression);
    const auto plan =
        unroll(prelude() + defined + "(if (equal " + expression + " '" + wanted + ") (go1) (go2))");
    REQUIRE(plan.graph.has_value());
    CHECK(plan.events("+") == Strings{"Go(r1)", "DONE"});
  }
}

TEST_CASE("forms: the entry is the named function, else the bare forms, else the last function") {
  UnrollOptions named;
  named.entry = "go1";
  CHECK(unroll(prelude() + "(go2)", named).events("+").front() == "Go(r1)");
  CHECK(unroll(prelude() + "(go2)(go1)").events("++") == Strings{"Go(r2)", "Go(r1)", "DONE"});
  CHECK(unroll(prelude() + "(defun last-one () (go2))").events("+").front() == "Go(r2)");
}

TEST_CASE("forms: paths that reach the same state are one location") {
  // Each failure is swallowed, so both outcomes of a perform meet again: no 2^10 paths.
  std::string text = prelude() +
                     "(defun try () (with-failure-handling ((plan-failure (e) "
                     "(return))) (sig)) nil)";
  for (int i = 0; i < 10; ++i) text += "(try)";
  const auto plan = unroll(text);
  REQUIRE(plan.graph.has_value());
  CHECK(plan.graph->locations.size() == 10);
  CHECK(longest_path(*plan.graph) == 10);
}

TEST_CASE("forms: different values keep paths apart") {
  const auto plan = unroll(prelude() + R"(
(let ((ok t))
  (with-failure-handling ((plan-failure (e) (setf ok nil) (return))) (sig))
  (if ok (go1) (go2)))
)");
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("++") == Strings{"Signal()", "Go(r1)", "DONE"});
  CHECK(plan.events("-+") == Strings{"Signal()", "Go(r2)", "DONE"});
}

TEST_CASE("forms: an endless loop that comes back to its state is a cycle, not a bound") {
  const auto plan = unroll(prelude() + "(loop (go1) (go2))");
  REQUIRE(plan.graph.has_value());
  CHECK(plan.graph->locations.size() == 2);
  CHECK(plan.walk("++++") == "L0 L1 L0 L1 L0");
  CHECK_FALSE(longest_path(*plan.graph).has_value());
}

TEST_CASE("forms: an endless loop through new states is cut at the bound") {
  UnrollOptions options;
  options.limits.max_loop = 3;
  const auto plan =
      unroll(prelude() + "(let ((n 0)) (loop while (>= n 0) do (sig) (incf n)))", options);
  REQUIRE(plan.graph.has_value());
  CHECK(plan.graph->locations.size() == 3);
  CHECK(plan.walk("+++").substr(0, 15) == "L0 L1 L2 BOUND(");
  CHECK(plan.target(plan.graph->locations[LocationId(2)].on_success).find("BOUND(loop at ") == 0);
}

TEST_CASE("forms: recursion that performs is cut at the bound") {
  UnrollOptions options;
  options.limits.max_call_depth = 4;
  const auto plan = unroll(prelude() + "(defun again () (sig) (again))(again)", options);
  CHECK(plan.codes().empty());
  REQUIRE(plan.graph.has_value());
  CHECK(plan.graph->locations.size() == 4);
  CHECK(plan.events("++++").back().find("BOUND(again at plan.lisp:") == 0);
}

TEST_CASE("forms: holds and comparisons with a detected object are decided by the model") {
  UnrollOptions options;
  options.fluents = {"RobotAt", "Holding"};
  options.constants = {"r1", "bowl", "bowl1", "left", "box"};
  const auto plan = unroll(prelude() + R"(
(when (holds '(robot-at r1))
  (let ((?o (perform (a motion (type detecting) (object (an object (type bowl)))))))
    (if (eq ?o :bowl1) (pick) (sig))))
)",
                           options);
  CHECK(plan.codes().empty());
  REQUIRE(plan.graph.has_value());
  REQUIRE(plan.graph->branches.size() == 2);
  CHECK(plan.graph->branches[BranchId(0)].guard.text == "RobotAt(r1)");
  CHECK(plan.graph->branches[BranchId(1)].guard.text == "?i1=bowl1");
  CHECK(plan.walk("-") == "B0 DONE");
  CHECK(plan.events("++++") == Strings{"Detect(bowl)", "PickUp(left,box)", "DONE"});
  CHECK(plan.events("++-+") == Strings{"Detect(bowl)", "Signal()", "DONE"});
}

TEST_CASE("forms: a silent loop over the model is cut, never endless") {
  const auto plan = unroll(prelude() + "(loop until (holds '(f)) do (list 1))(sig)");
  REQUIRE(plan.graph.has_value());
  CHECK(plan.graph->branches.size() == 16);
  CHECK(longest_path(*plan.graph) == 1);
  CHECK(plan.events(std::string(16, '-')).back().find("BOUND(loop") == 0);
}

TEST_CASE("forms: an action can be a function of the plan") {
  const std::string binding = std::string(kBinding) +
                              "action fetching (:object ?o :arm ?a) -> plan fetch(?o,?a)\n"
                              "action wandering () -> plan nowhere()\n"
                              "action waving (:arm ?a) -> plan fetch(?a)\n";
  const std::string fetch = prelude() + R"(
(defun fetch (?what ?arm)
  (go1)
  (perform (an action (type picking-up) (arm ?arm) (object ?what)))
  ?what)
)";
  const auto plan = unroll(fetch + R"(
(let ((?got (perform (an action (type fetching) (arm left) (object (an object (name box)))))))
  (when (eq (desig-prop-value ?got :name) :box) (sig)))
)",
                           {}, binding);
  REQUIRE(plan.codes().empty());
  CHECK(plan.events("+++") == Strings{"Go(r1)", "PickUp(left,box)", "Signal()", "DONE"});
  CHECK(plan.events("-") == Strings{"Go(r1)", "FAILED(navigation-pose-unreachable)"});
  CHECK(unroll("(perform (an action (type wandering)))", {}, binding).codes() == Strings{"CPL010"});
  CHECK(unroll(fetch + "(perform (an action (type waving) (arm left)))", {}, binding).codes() ==
        Strings{"CPL007"});
  // A function that calls itself without performing anything is reported as in any other call.
  CHECK(unroll("(defun fetch (?o ?a) (perform (an action (type fetching) (object ?o) (arm ?a))))"
               "(fetch 'box 'left)",
               {}, binding)
            .codes() == Strings{"CPL050"});
}

TEST_CASE("forms: next-solution gives as many further locations as asked for") {
  const std::string text = prelude() + R"(
(let ((?where (a location (pose *p1*))) (tries 0))
  (loop while ?where do (incf tries) (perform (a motion (type going) (target ?where)))
                        (setf ?where (next-solution ?where)))
  (dotimes (i tries) (sig)))
)";
  UnrollOptions options;
  for (int samples = 0; samples < 3; ++samples) {
    options.limits.location_samples = samples;
    const auto plan = unroll(text, options);
    REQUIRE(plan.graph.has_value());
    const std::size_t performs = 2 * (static_cast<std::size_t>(samples) + 1);
    const auto events = plan.events(std::string(performs, '+'));
    REQUIRE(events.size() == performs + 1);
    CHECK(events.back() == "DONE");
    CHECK(events[performs / 2 - 1] == "Go(r1)");
    // The controller and the reader of a trace are told which sample it is.
    const auto& last = plan.graph->locations[LocationId(static_cast<std::uint32_t>(samples))];
    CHECK(last.arguments.contains("target.solution") == (samples > 0));
  }
}

TEST_CASE("forms: conditional properties of designators") {
  const std::string text = prelude() + R"(
(defun grasp (?arm)
  (perform (an action (type picking-up) (object (an object (name box)))
              (when ?arm (arm ?arm)))))
)";
  CHECK(unroll(text + "(grasp :right)").events("+").front() == "PickUp(right,box)");
  CHECK(unroll(text + "(grasp nil)").has("CPL030"));
}

TEST_CASE("forms: a designator in a variable, pose helpers and aliases") {
  const auto plan = unroll(R"(
(let* ((?p (pose->pose-stamped "map" 0.0 (make-pose (make-3d-vector 0.25 0 0)
                                                    (make-identity-rotation))))
       (?where (a location (pose ?p)))
       (?move (an action (type navigating) (target ?where))))
  (perform ?move)
  (perform (an action (type turning-towards) (location (desig-prop-value ?move :target))))
  (perform (a motion (type going) (pose (make-identity-pose)))))
)");
  CHECK(plan.has("CPL030") == false);
  // `(desig-prop-value ...)` inside a designator is a list of symbols, not a call.
  CHECK(plan.has("CPL033"));
}

}  // namespace
}  // namespace parallax::compiler
