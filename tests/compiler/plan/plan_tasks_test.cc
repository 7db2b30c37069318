// Tasks: the body of a def-cram-function, a branch of `par`, a tagged form, a top-level form.
#include <doctest/doctest.h>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

TEST_CASE("tasks: clean-ups inside run before the handlers around, within one task after them") {
  const std::string main =
      " f () (unwind-protect (go1) (sig)))"
      "(with-failure-handling ((plan-failure (e) (pick) (return))) (f))(go2)";
  CHECK(with_prelude("(def-cram-function" + main).events("-+++") ==
        Strings{"Go(r1)", "Signal()", "PickUp(left,box)", "Go(r2)", "DONE"});
  CHECK(with_prelude("(defun" + main).events("-+++") ==
        Strings{"Go(r1)", "PickUp(left,box)", "Signal()", "Go(r2)", "DONE"});
  // A clean-up that fails replaces the failure, and the handler around runs once.
  CHECK(with_prelude("(def-cram-function" + main).events("--++") ==
        Strings{"Go(r1)", "Signal()", "PickUp(left,box)", "Go(r2)", "DONE"});
}

TEST_CASE("tasks: handlers inside are asked first, then the task ends, then those around") {
  const auto plan = with_prelude(
      "(def-cram-function f () (with-failure-handling ((plan-failure (e) (go2)))"
      " (unwind-protect (go1) (sig))))"
      "(with-failure-handling ((plan-failure (e) (pick) (return))) (f))");
  CHECK(plan.events("-+++") == Strings{"Go(r1)", "Go(r2)", "Signal()", "PickUp(left,box)", "DONE"});
  const auto nested = with_prelude(
      "(def-cram-function f () (unwind-protect (go1) (sig)))"
      "(def-cram-function g () (unwind-protect (f) (go2)))"
      "(with-retry-counters ((n 1)) (with-failure-handling ((plan-failure (e) (pick) (do-retry n "
      "(retry)))) (g)))");
  CHECK(nested.events("-++++++") == Strings{"Go(r1)", "Signal()", "Go(r2)", "PickUp(left,box)",
                                            "Go(r1)", "Signal()", "Go(r2)", "DONE"});
}

TEST_CASE("tasks: a branch of par in written order is one as well") {
  const auto plan = unroll(prelude() +
                           "(with-failure-handling ((plan-failure (e) (pick) (return)))"
                           " (par (unwind-protect (go1) (sig)) (go2)))");
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("-++") == Strings{"Go(r1)", "Signal()", "PickUp(left,box)", "DONE"});
  CHECK(plan.events("+++") == Strings{"Go(r1)", "Signal()", "Go(r2)", "DONE"});
}

TEST_CASE("tasks: nothing returns out of one, and the message names the repair") {
  for (const std::string text :
       {"(def-cram-function f () (return-from f 1))(f)",
        "(block out (par (return-from out) (go1)))", "(dolist (x '(1)) (top-level (return)))",
        "(block out (with-tags (:tag one (return-from out))))"}) {
    CAPTURE(text);
    const auto plan = unroll(prelude() + text);
    CHECK(plan.has("CPL042"));
    bool named = false;
    for (const auto& found : plan.sink.sorted()) {
      for (const auto& note : found.notes) {
        named = named || note.text.find("put `(block ") != std::string::npos;
      }
    }
    CHECK(named);
  }
  const auto repaired =
      with_prelude("(def-cram-function f () (block f (return-from f 1) (go1)))(f)");
  CHECK(repaired.events("") == Strings{"DONE"});
}

TEST_CASE("tasks: a top-level function does not run in another") {
  const std::string inner = "(def-top-level-cram-function f () (sig))";
  const auto nested = unroll(prelude() + inner + "(defun g () (go1) (f))(g)");
  CHECK(nested.codes() == Strings{"W-ERROR"});
  CHECK(nested.events("+") == Strings{"Go(r1)", "FAILED(simple-error)"});
  CHECK(with_prelude(inner + "(f)").events("+") == Strings{"Signal()", "DONE"});
  CHECK(with_prelude(inner).events("+") == Strings{"Signal()", "DONE"});
}

TEST_CASE("tasks: a rebound special is seen by what is called in the same task only") {
  const std::string text =
      "(defparameter *where* *p1*)"
      "(defun plain () (let ((?to *where*)) (perform (a motion (type going) (target ?to)))))"
      "(def-cram-function own () (plain))"
      "(let ((*where* *p2*)) (plain) (own) (setf *where* *p1*) (plain))(plain)";
  CHECK(with_prelude(text).events("++++") ==
        Strings{"Go(r2)", "Go(r1)", "Go(r1)", "Go(r1)", "DONE"});
  // A handler runs where the failure was signalled: it sees the bindings there.
  const auto handled = with_prelude(
      "(defparameter *where* *p1*)"
      "(defun there () (let ((?to *where*)) (perform (a motion (type going) (target ?to)))))"
      "(with-failure-handling ((plan-failure (e) (there) (return)))"
      " (let ((*where* *p2*)) (sig)))"
      "(there)");
  CHECK(handled.events("-++") == Strings{"Signal()", "Go(r2)", "Go(r1)", "DONE"});
}

TEST_CASE("handlers: one that declines passes to the next clause of its form, then outward") {
  const auto plan = with_prelude(R"(
(with-failure-handling ((plan-failure (e) (pick) (return)))
  (with-failure-handling ((navigation-low-level-failure (e) (sig))
                          (perception-low-level-failure (e) (go1))
                          (low-level-failure (e) (go2)))
    (go1)))
)");
  CHECK(plan.events("-+++") == Strings{"Go(r1)", "Signal()", "Go(r2)", "PickUp(left,box)", "DONE"});
  // (or A B) stands for two clauses; of two with one class the last is called, for both.
  const auto twice = with_prelude(R"(
(with-failure-handling (((or navigation-low-level-failure low-level-failure) (e) (sig))) (go1))
)");
  CHECK(twice.events("-++").back() == "FAILED(navigation-pose-unreachable)");
  CHECK(twice.events("-++") ==
        Strings{"Go(r1)", "Signal()", "Signal()", "FAILED(navigation-pose-unreachable)"});
  const auto same = with_prelude(R"(
(with-failure-handling ((low-level-failure (e) (go2)) (low-level-failure (e) (sig))) (go1))
)");
  CHECK(same.events("-++") ==
        Strings{"Go(r1)", "Signal()", "Signal()", "FAILED(navigation-pose-unreachable)"});
}

TEST_CASE("handlers: a Lisp error is no plan failure") {
  const auto plan = unroll(prelude() + R"(
(with-failure-handling ((error (e) (go2) (return)))
  (with-failure-handling ((plan-failure (e) (sig) (return))) (ecase 1 (2 3))))
(with-failure-handling ((serious-condition (e) (pick) (return))) (error "no ~a" 1))
(with-failure-handling ((serious-condition (e) (return)))
  (fail (make-condition 'object-unfetchable :object 1)))
)");
  CHECK(plan.codes().empty());
  CHECK(plan.events("++") == Strings{"Go(r2)", "PickUp(left,box)", "DONE"});
}

TEST_CASE("handlers: retry in the body, return in try-in-order") {
  const auto plan = with_prelude(R"(
(let ((n 0))
  (with-failure-handling ((plan-failure (e) (return)))
    (incf n) (unwind-protect (go1) (sig)) (when (< n 2) (retry)) (go2)))
(when (eq (try-in-order (progn (pick) (return :x) (go1)) (go2)) :x) (sig))
)");
  CHECK(plan.events("+++++++") == Strings{"Go(r1)", "Signal()", "Go(r1)", "Signal()", "Go(r2)",
                                          "PickUp(left,box)", "Signal()", "DONE"});
  CHECK(plan.events("-+-+") == Strings{"Go(r1)", "Signal()", "PickUp(left,box)", "Go(r2)", "DONE"});
}

}  // namespace
}  // namespace parallax::compiler
