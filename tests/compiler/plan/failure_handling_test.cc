#include <doctest/doctest.h>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

TEST_CASE("failures: the first clause in written order whose class fits") {
  const auto plan = with_prelude(R"(
(with-failure-handling
    ((manipulation-low-level-failure (e) (go2) (return))
     (low-level-failure (e) (go1) (return))
     (navigation-pose-unreachable (e) (sig) (return)))
  (go1) (pick))
)");
  // Going fails: low-level-failure comes before navigation-pose-unreachable.
  CHECK(plan.events("-+") == Strings{"Go(r1)", "Go(r1)", "DONE"});
  CHECK(plan.events("+-+") == Strings{"Go(r1)", "PickUp(left,box)", "Go(r2)", "DONE"});
}

TEST_CASE("failures: a handler that falls through passes the same failure outward") {
  const auto plan = with_prelude(R"(
(with-failure-handling ((navigation-low-level-failure (e) (go2) (return)))
  (with-failure-handling ((navigation-low-level-failure (e) (sig)))
    (go1)))
(pick)
)");
  CHECK(plan.events("-+++") == Strings{"Go(r1)", "Signal()", "Go(r2)", "PickUp(left,box)", "DONE"});
  // The performs of a handler can fail as well; that failure goes to the outer handler only.
  CHECK(plan.events("--") == Strings{"Go(r1)", "Signal()", "FAILED(simple-plan-failure)"});
}

TEST_CASE("failures: a failure in a handler is not caught by the same form") {
  const auto plan = with_prelude(R"(
(with-failure-handling ((plan-failure (e) (sig) (return)))
  (with-failure-handling ((navigation-low-level-failure (e) (go2) (return))) (go1)))
)");
  CHECK(plan.events("--+") == Strings{"Go(r1)", "Go(r2)", "Signal()", "DONE"});
}

TEST_CASE("failures: a form inside a handler catches the failures of that handler") {
  const auto plan = with_prelude(R"(
(with-failure-handling
    ((navigation-low-level-failure (e)
       (with-failure-handling ((plan-failure (e) (pick) (return))) (go2))
       (return)))
  (go1))
)");
  CHECK(plan.events("--+") == Strings{"Go(r1)", "Go(r2)", "PickUp(left,box)", "DONE"});
  CHECK(plan.events("---").back() == "FAILED(manipulation-pose-unreachable)");
}

TEST_CASE("failures: a retry counter allows exactly that many retries") {
  const auto plan = with_prelude(R"(
(with-retry-counters ((tries 2))
  (with-failure-handling ((plan-failure (e) (do-retry tries (go2) (retry)))) (pick)))
)");
  CHECK(plan.events("-+-+-") == Strings{"PickUp(left,box)", "Go(r2)", "PickUp(left,box)", "Go(r2)",
                                        "PickUp(left,box)",
                                        "FAILED(manipulation-pose-unreachable)"});
  CHECK(plan.graph->locations.size() == 5);
  CHECK(longest_path(*plan.graph) == 5);
}

TEST_CASE("failures: counters can be read and reset") {
  const auto plan = with_prelude(R"(
(with-retry-counters ((inner 1) (outer 1))
  (with-failure-handling
      ((plan-failure (e) (do-retry outer (reset-counter inner) (retry))))
    (with-failure-handling ((plan-failure (e) (do-retry inner (retry)))) (sig)))
  (when (= (get-counter inner) 1) (go1)))
)");
  // 2 inner attempts, twice.
  CHECK(plan.events("----").back() == "FAILED(simple-plan-failure)");
  CHECK(plan.events("---+") == Strings{"Signal()", "Signal()", "Signal()", "Signal()", "DONE"});
  CHECK(plan.events("++") == Strings{"Signal()", "Go(r1)", "DONE"});
  CHECK(plan.events("--++") == Strings{"Signal()", "Signal()", "Signal()", "Go(r1)", "DONE"});
}

TEST_CASE("failures: what a handler sets is visible after a retry") {
  const auto plan = with_prelude(R"(
(let ((?where *p1*))
  (with-retry-counters ((n 1))
    (with-failure-handling ((plan-failure (e) (do-retry n (setf ?where *p2*) (retry))))
      (perform (a motion (type going) (target ?where))))))
)");
  CHECK(plan.events("-+") == Strings{"Go(r1)", "Go(r2)", "DONE"});
}

TEST_CASE("failures: a handler is one place, whatever failed in the body") {
  const auto plan = with_prelude(R"(
(with-failure-handling ((plan-failure (e) (pick) (sig) (return)))
  (go1) (go2) (go1) (go2) (go1))
)");
  CHECK(plan.graph->locations.size() == 5 + 2);
  // With a clean-up in between, the rest of the clean-ups still matters.
  const auto cleaned = with_prelude(R"(
(with-failure-handling ((navigation-low-level-failure (e) (go2) (return)))
  (unwind-protect (go1) (sig))
  (go1))
)");
  CHECK(cleaned.events("-++") == Strings{"Go(r1)", "Go(r2)", "Signal()", "DONE"});
  CHECK(cleaned.events("++-+") == Strings{"Go(r1)", "Signal()", "Go(r1)", "Go(r2)", "DONE"});
}

TEST_CASE("failures: an endless retry is a cycle") {
  const auto plan = with_prelude("(with-failure-handling ((plan-failure (e) (retry))) (sig))");
  CHECK(plan.graph->locations.size() == 1);
  CHECK(plan.walk("--+") == "L0 L0 L0 DONE");
}

TEST_CASE("failures: return values, or classes and rethrowing") {
  const auto plan = with_prelude(R"(
(let ((got (with-failure-handling
               (((or navigation-low-level-failure perception-object-unfound) (e)
                 (when (typep e 'navigation-low-level-failure) (return :lost))))
             (go1) :there)))
  (if (eq got :there) (go2) (sig)))
(with-failure-handling ((simple-plan-failure (e) (fail e))) (pick))
)");
  CHECK(plan.events("+++") == Strings{"Go(r1)", "Go(r2)", "PickUp(left,box)", "DONE"});
  CHECK(plan.events("-++") == Strings{"Go(r1)", "Signal()", "PickUp(left,box)", "DONE"});
  CHECK(plan.events("++-").back() == "FAILED(manipulation-pose-unreachable)");
}

TEST_CASE("failures: fail with a class, a text, nothing and an own class") {
  const auto last = [](const std::string& body) { return with_prelude(body).events("").back(); };
  CHECK(last("(fail 'object-unfetchable :object 1)") == "FAILED(object-unfetchable)");
  CHECK(last("(fail \"no ~a\" 1)") == "FAILED(simple-plan-failure)");
  CHECK(last("(fail)") == "FAILED(simple-plan-failure)");
  CHECK(last("(ecase 'a (b 1))") == "FAILED(case-failure)");
  CHECK(last("(define-condition lost (navigation-low-level-failure) ((where :initarg :where)))"
             "(with-failure-handling ((low-level-failure (e) (fail 'common-fail:lost)))"
             " (fail 'lost))") == "FAILED(lost)");
  const auto plan = with_prelude(
      "(define-condition lost (navigation-low-level-failure) ())"
      "(with-failure-handling ((navigation-low-level-failure (e) (sig) (return))) (fail 'lost))");
  CHECK(plan.events("+") == Strings{"Signal()", "DONE"});
}

TEST_CASE("failures: clean-up runs on every exit, after the handler has decided") {
  const auto plan = with_prelude(R"(
(with-retry-counters ((n 1))
  (with-failure-handling
      ((navigation-low-level-failure (e) (do-retry n (pick) (retry)) (return)))
    (unwind-protect (go1) (sig))))
(go2)
)");
  CHECK(plan.events("+++") == Strings{"Go(r1)", "Signal()", "Go(r2)", "DONE"});
  // The handler picks first, then the clean-up signals, then the body starts again.
  CHECK(plan.events("-++-++") ==
        Strings{"Go(r1)", "PickUp(left,box)", "Signal()", "Go(r1)", "Signal()", "Go(r2)", "DONE"});
}

TEST_CASE("failures: clean-up runs when nobody handles the failure and on local exits") {
  const auto unhandled = with_prelude("(unwind-protect (unwind-protect (go1) (sig)) (go2))");
  CHECK(unhandled.events("-++") ==
        Strings{"Go(r1)", "Signal()", "Go(r2)", "FAILED(navigation-pose-unreachable)"});
  // A failure in a clean-up replaces the one that caused it.
  CHECK(unhandled.events("--+") ==
        Strings{"Go(r1)", "Signal()", "Go(r2)", "FAILED(simple-plan-failure)"});
  const auto local =
      with_prelude("(dolist (x '(1 2)) (unwind-protect (progn (go1) (return)) (sig)))(go2)");
  CHECK(local.events("+++") == Strings{"Go(r1)", "Signal()", "Go(r2)", "DONE"});
  const auto value = with_prelude(
      "(defun f () (unwind-protect (return-from f :a) (sig)))(if (eq (f) :a) (go1) (go2))");
  CHECK(value.events("++") == Strings{"Signal()", "Go(r1)", "DONE"});
}

TEST_CASE("failures: they pass through calls, and handlers see the variables around them") {
  const auto plan = with_prelude(R"(
(defun deep () (go1))
(defun middle () (unwind-protect (deep) (sig)))
(let ((seen nil))
  (with-failure-handling ((plan-failure (e) (setf seen t) (return))) (middle))
  (when seen (go2)))
)");
  CHECK(plan.events("-++") == Strings{"Go(r1)", "Signal()", "Go(r2)", "DONE"});
  CHECK(plan.events("++") == Strings{"Go(r1)", "Signal()", "DONE"});
}

TEST_CASE("failures: try-in-order and try-each-in-order take the next branch") {
  const auto plan = with_prelude("(try-in-order (go1) (pick))(sig)");
  CHECK(plan.events("++") == Strings{"Go(r1)", "Signal()", "DONE"});
  CHECK(plan.events("-++") == Strings{"Go(r1)", "PickUp(left,box)", "Signal()", "DONE"});
  CHECK(plan.events("--").back() == "FAILED(composite-failure)");
  const auto each = with_prelude(
      "(try-each-in-order (?p (list *p1* *p2*)) (perform (a motion (type going) (target ?p))))");
  CHECK(each.events("-+") == Strings{"Go(r1)", "Go(r2)", "DONE"});
  CHECK(each.events("--").back() == "FAILED(composite-failure)");
}

TEST_CASE("failures: the tutorial's handle-failure macro") {
  const auto plan = with_prelude(
      "(handle-failure (navigation-pose-unreachable ptu-goal-unreachable) ((go1) (pick)) (sig) "
      "(return))");
  CHECK(plan.events("-+") == Strings{"Go(r1)", "Signal()", "DONE"});
  CHECK(plan.events("+-").back() == "FAILED(manipulation-pose-unreachable)");
}

TEST_CASE("failures: three nested handlers with counters keep their counts apart") {
  const auto plan = with_prelude(R"(
(with-retry-counters ((a 1) (b 1) (c 1))
  (with-failure-handling ((plan-failure (e) (do-retry a (retry)) (return)))
    (with-failure-handling ((plan-failure (e) (do-retry b (retry))))
      (with-failure-handling ((plan-failure (e) (do-retry c (retry))))
        (sig)))))
(go1)
)");
  // One attempt and three retries in all, whoever orders them; then the outermost gives up.
  CHECK(plan.events("----+") ==
        Strings{"Signal()", "Signal()", "Signal()", "Signal()", "Go(r1)", "DONE"});
  CHECK(plan.graph->locations.size() == 5);
}

TEST_CASE("failures: explored by reason, every condition that the table names has its way") {
  const std::string going =
      "motion going (:target ?p) -> Go(region(?p)) ok: RobotAt(region(?p)) @t+1 else "
      "navigation-pose-unreachable";
  const std::string rest = "\nmotion signalling -> Signal() ok: Signalled() @t+1\n";
  const std::string reasons =
      " on blocked navigation-goal-not-reached on lost-way navigation-pose-unreachable"
      " on stuck navigation-goal-not-reached on flat low-level-failure";
  const std::string plan = R"(
(with-failure-handling ((navigation-pose-unreachable (e) (perform (a motion (type signalling))) (return)))
  (perform (a motion (type going)
    (target (make-pose-stamped "map" 0 (make-3d-vector 1.5 0 0) (make-identity-rotation))))))
)";
  UnrollOptions options;
  const auto plain = unroll(plan, options, going + rest);
  const auto named = unroll(plan, options, going + reasons + rest);
  REQUIRE(plain.graph.has_value());
  REQUIRE(named.graph.has_value());
  // Where nothing is executed the reasons change nothing.
  CHECK(dump_text(*named.graph, named.files) == dump_text(*plain.graph, plain.files));
  options.failures_by_reason = true;
  CHECK(dump_text(*unroll(plan, options, going + rest).graph, plain.files) ==
        dump_text(*plain.graph, plain.files));
  const auto found = unroll(plan, options, going + reasons + rest);
  REQUIRE(found.graph.has_value());
  const auto& graph = *found.graph;
  const auto& location = graph.locations[LocationId(0)];
  REQUIRE(location.failures.size() == 3);
  CHECK(location.failures[0].reasons == Strings{"blocked", "stuck"});
  CHECK(found.target(failure_target(graph, location, 0)) == "FAILED(navigation-goal-not-reached)");
  CHECK(found.target(failure_target(graph, location, 1)) == "L1");
  CHECK(found.target(failure_target(graph, location, 2)) == "FAILED(low-level-failure)");
  REQUIRE(graph.handlers.size() == 1);
  CHECK(graph.handlers[0].failures == std::vector{LocationId(0)});
  CHECK(unroll(plan, options, going + " on blocked no-such-class" + rest).has("CPL041"));
}

}  // namespace
}  // namespace parallax::compiler
