#include <doctest/doctest.h>

#include <set>

#include "tests/compiler/plan/plan_fixture.h"
#include "tests/compiler/plan/ways.h"

namespace parallax::compiler {
namespace {

std::size_t orders(const std::string& text) {
  const auto plan = by_turns(text);
  REQUIRE(plan.graph.has_value());
  CHECK(plan.codes().empty());
  return Ways(plan).all.size();
}

std::string opens(const std::string& name, int count) {
  std::string out;
  for (int i = 1; i <= count; ++i) {
    out += "(perform (an action (type opening) (object (an object (name " + name +
           std::to_string(i) + ")))))";
  }
  return "(seq " + out + ")";
}

TEST_CASE("branches: every order of their performs is explored") {
  // (a + b)! / (a! b!) orders of a and b performs; (a + b + c)! / (a! b! c!) of three branches.
  CHECK(orders("(par " + opens("a", 1) + opens("b", 1) + ")") == 2);
  CHECK(orders("(par " + opens("a", 2) + opens("b", 2) + ")") == 6);
  CHECK(orders("(par " + opens("a", 3) + opens("b", 4) + ")") == 35);
  CHECK(orders("(par " + opens("a", 2) + opens("b", 2) + opens("c", 2) + ")") == 90);
  CHECK(orders("(par " + opens("a", 2) + "(list 1))") == 1);
  CHECK(orders("(par (list 1) (list 2))") == 1);
  // A par within a branch: 4 performs, of which one pair is in order and follows two free ones.
  CHECK(orders("(par " + opens("a", 2) + "(par " + opens("b", 1) + opens("c", 1) + "))") == 12);
  CHECK(orders("(par " + opens("a", 1) + "(seq (par " + opens("b", 1) + opens("c", 1) + ") " +
               opens("d", 1) + "))") == 8);
  // Two in a row.
  CHECK(orders("(par " + opens("a", 1) + opens("b", 1) + ")(par " + opens("c", 1) + opens("d", 1) +
               ")") == 4);
}

TEST_CASE("branches: paths that meet in one state are one location") {
  const auto plan = by_turns("(par " + opens("a", 6) + opens("b", 6) + ")");
  REQUIRE(plan.graph.has_value());
  // 7 x 7 positions less the last; two performs at each that has both branches open. And each
  // perform once more, carried out after the other branch has failed.
  CHECK(plan.graph->locations.size() == 2 * 6 * 6 + 6 + 6 + 12);
}

TEST_CASE("branches: after the first failure the others carry out what they wait at, no more") {
  const auto plan = by_turns("(with-failure-handling ((plan-failure (e) (sig) (return))) (par " +
                             opens("a", 1) + "(seq " + opens("b", 1) + "(go1))))(go2)");
  REQUIRE(plan.graph.has_value());
  CHECK(Ways(plan, {"OpenDrawer(b1)"}).all ==
        std::set<std::string>{"OpenDrawer(a1) OpenDrawer(b1) Signal() Go(r2) DONE",
                              "OpenDrawer(b1) OpenDrawer(a1) Signal() Go(r2) DONE",
                              "OpenDrawer(b1) Signal() Go(r2) DONE"});
  CHECK(Ways(plan, {"OpenDrawer(a1)"}).all ==
        std::set<std::string>{"OpenDrawer(a1) Signal() Go(r2) DONE",
                              "OpenDrawer(a1) OpenDrawer(b1) Signal() Go(r2) DONE",
                              "OpenDrawer(b1) OpenDrawer(a1) Signal() Go(r2) DONE",
                              "OpenDrawer(b1) OpenDrawer(a1) Go(r1) Signal() Go(r2) DONE",
                              "OpenDrawer(b1) Go(r1) OpenDrawer(a1) Signal() Go(r2) DONE"});
  // If two branches fail, the first failure counts.
  const auto both = by_turns(
      "(with-failure-handling ((navigation-low-level-failure (e) (sig) (return)) "
      "(manipulation-low-level-failure (e) (pick) (return))) (par (go1) " +
      opens("b", 1) + "))");
  CHECK(Ways(both, {"Go(r1)", "OpenDrawer(b1)"}).all ==
        std::set<std::string>{"Go(r1) Signal() DONE", "Go(r1) OpenDrawer(b1) Signal() DONE",
                              "OpenDrawer(b1) PickUp(left,box) DONE",
                              "OpenDrawer(b1) Go(r1) PickUp(left,box) DONE"});
}

TEST_CASE("branches: a failure that a branch handles itself leaves the others alone") {
  const auto plan = by_turns("(par (with-failure-handling ((plan-failure (e) (sig) (return))) " +
                             opens("a", 1) + ")" + opens("b", 1) + ")");
  REQUIRE(plan.graph.has_value());
  CHECK(Ways(plan, {"OpenDrawer(a1)"}).all ==
        std::set<std::string>{"OpenDrawer(a1) Signal() OpenDrawer(b1) DONE",
                              "OpenDrawer(a1) OpenDrawer(b1) Signal() DONE",
                              "OpenDrawer(b1) OpenDrawer(a1) Signal() DONE"});
}

TEST_CASE("branches: they share variables, and the value is that of the first") {
  const auto shared = by_turns(
      "(let ((n 0) (last nil)) (setf last (par (seq (go1) (incf n) :a) "
      "(seq (go2) (incf n) :b))) (when (and (= n 2) (eq last :a)) (sig)))");
  CHECK(Ways(shared).all ==
        std::set<std::string>{"Go(r1) Go(r2) Signal() DONE", "Go(r2) Go(r1) Signal() DONE"});
  CHECK(by_turns("(when (eq (par :a) :a) (sig))").events("+") == Strings{"Signal()", "DONE"});
  CHECK(by_turns("(par)").codes() == Strings{"W-ERROR"});
}

TEST_CASE("branches: nothing jumps out of one, whether by turns or in written order") {
  for (const std::string text :
       {"(block out (par (seq (go1) (return-from out)) (go2)))",
        "(dolist (x '(1 2)) (par (seq (go1) (return)) (go2)))",
        "(with-failure-handling ((plan-failure (e) (return))) (par (return) (go2)))"}) {
    CAPTURE(text);
    CHECK(by_turns(text).codes() == Strings{"CPL042"});
    CHECK(unroll(prelude() + text).has("CPL042"));
  }
  const std::string retry =
      "(with-failure-handling ((plan-failure (e) (return))) (par (retry) (go2)))";
  CHECK(by_turns(retry).codes() == Strings{"CPL040"});
  // A local function may hide the jump until it is called.
  const std::string hidden =
      "(block out (flet ((leave () (return-from out))) (par (leave) (go2))))";
  CHECK(by_turns(hidden).codes() == Strings{"CPL042"});
  CHECK(by_turns("(par (block in (go1) (return-from in) (pick)) (go2))").codes().empty());
}

TEST_CASE("branches: clean-up in a branch runs, also when another one's failure ends it") {
  const auto own = by_turns(
      "(par (unwind-protect (go1) (sig))"
      " (with-failure-handling ((plan-failure (e) (return))) (pick)))");
  CHECK(Ways(own).all.size() == 3);
  // The handler decides first; the other branch's clean-ups follow.
  const auto other = by_turns(
      "(with-failure-handling ((plan-failure (e) (return))) (par (unwind-protect (seq (go1) (go2)) "
      "(sig)) (pick)))" +
      opens("d", 1));
  CHECK(Ways(other, {"PickUp(left,box)"}).all ==
        std::set<std::string>{"PickUp(left,box) Signal() OpenDrawer(d1) DONE",
                              "PickUp(left,box) Go(r1) Signal() OpenDrawer(d1) DONE",
                              "PickUp(left,box) OpenDrawer(d1) DONE",
                              "PickUp(left,box) Go(r1) OpenDrawer(d1) DONE",
                              "Go(r1) PickUp(left,box) OpenDrawer(d1) DONE",
                              "Go(r1) PickUp(left,box) Signal() OpenDrawer(d1) DONE",
                              "Go(r1) PickUp(left,box) Go(r2) Signal() OpenDrawer(d1) DONE",
                              "Go(r1) Go(r2) PickUp(left,box) Signal() OpenDrawer(d1) DONE",
                              "Go(r1) Go(r2) Signal() PickUp(left,box) OpenDrawer(d1) DONE"});
  // Nested, and with a clean-up of each branch: those of the first branch come first.
  const auto nested = by_turns(
      "(par (let ((?x *p1*)) (unwind-protect (par (unwind-protect (pick) (perform (a motion (type "
      "going) (target ?x)))) (go2)) " +
      opens("b", 1) + ")) (sig))");
  for (const auto& way : Ways(nested, {"Signal()"}).all) {
    CAPTURE(way);
    CHECK(way.ends_with("FAILED(simple-plan-failure)"));
    if (way.find("OpenDrawer(b1)") == std::string::npos) continue;  // it comes behind everything
    CHECK(way.find("Go(r1)") < way.find("OpenDrawer(b1)"));
  }
  // A failure inside such a clean-up is lost.
  const auto lost = by_turns(
      "(with-failure-handling ((plan-failure (e) (return))) (par (unwind-protect (go1) (go2) (sig))"
      " (pick)))");
  CHECK(Ways(lost, {"PickUp(left,box)", "Go(r2)", "Go(r1)"})
            .all.contains("PickUp(left,box) Go(r2) DONE"));
}

TEST_CASE("branches: a clean-up of a branch that was ended goes nowhere but to its end") {
  // A jump out of it, a handler around it and a rebound global of another task.
  for (const std::string cleanup : {"(return-from b)", "(progn (return-from b) (go2))"}) {
    const auto jump = by_turns(
        "(with-failure-handling ((plan-failure (e) (return))) (par (seq (block b (unwind-protect "
        "(seq (go1) (go2)) " +
        cleanup + ")) (sig)) (pick)))" + opens("d", 1));
    REQUIRE(jump.graph.has_value());
    CHECK(Ways(jump, {"PickUp(left,box)"}).all.contains("PickUp(left,box) OpenDrawer(d1) DONE"));
    CHECK(!Ways(jump, {"PickUp(left,box)"})
               .all.contains("PickUp(left,box) Signal() OpenDrawer(d1) DONE"));
  }
  const auto retried = by_turns(
      "(with-failure-handling ((plan-failure (e) (return))) (par (with-failure-handling "
      "((plan-failure (e) (sig) (return))) (unwind-protect (go1) (go2))) (pick)))");
  CHECK(Ways(retried, {"PickUp(left,box)", "Go(r2)"}).all.contains("PickUp(left,box) Go(r2) DONE"));
  const auto special = by_turns(
      "(defparameter *to* *p1*)(defun there () (let ((?to *to*)) (perform (a motion (type going) "
      "(target ?to)))))"
      "(let ((*to* *p2*)) (with-failure-handling ((plan-failure (e) (there) (return))) "
      "(par (let ((*to* *p1*)) (unwind-protect (sig) (there))) (pick))))");
  const auto all = Ways(special, {"PickUp(left,box)"}).all;
  CHECK(all.contains("PickUp(left,box) Go(r2) Go(r1) DONE"));
  CHECK(all.contains("PickUp(left,box) Go(r1) Go(r2) DONE"));
}

TEST_CASE("branches: a branch begins even if another one has failed before its turn came") {
  const std::string fails = "(fail 'object-unfetchable)";
  const auto first = by_turns("(par " + fails + "(seq (go1) (go2)))");
  const auto last = by_turns("(par (seq (go1) (go2)) " + fails + ")");
  const std::set<std::string> both = {"FAILED(object-unfetchable)",
                                      "Go(r1) FAILED(object-unfetchable)"};
  CHECK(Ways(first).all == both);
  CHECK(Ways(last).all == both);
}

TEST_CASE("branches: a pursue ends with the first of its branches, and cleans up") {
  CHECK(orders("(pursue " + opens("a", 1) + opens("b", 1) + ")") == 4);
  CHECK(orders("(pursue (list 1) (list 2))") == 1);
  CHECK(by_turns("(when (eq (pursue :a :b) :a) (sig))").events("+") == Strings{"Signal()", "DONE"});
  // A pursue within a par within retries.
  const auto nested = by_turns(
      "(let ((tries 0)) (with-failure-handling ((plan-failure (e) (incf tries) (when (< tries 2) "
      "(retry)) (return))) (par (pursue (go1) (unwind-protect (seq (go2) (go1)) (sig))) "
      "(pick))))");
  REQUIRE(nested.graph.has_value());
  bool cleaned = false;  // clean-ups may also come behind everything else
  for (const auto& way : Ways(nested, {"PickUp(left,box)"}).all) {
    CAPTURE(way);
    CHECK(way.ends_with("DONE"));
    cleaned = cleaned || way.find("Signal()") != std::string::npos;
  }
  CHECK(cleaned);
  // In written order the first branch alone runs; the others are checked.
  const auto plan = unroll(prelude() + "(pursue (seq (go1) (sig)) (go2))");
  CHECK(plan.codes() == Strings{"W-PAR"});
  CHECK(plan.events("++") == Strings{"Go(r1)", "Signal()", "DONE"});
  CHECK(unroll(prelude() + "(pursue (go1) (nonsense))").has("CPL010"));
}

std::vector<std::string> gaps(const Unrolled& plan) {
  std::vector<std::string> out;
  for (const auto& gap : plan.graph->gaps) out.push_back(gap.text);
  return out;
}

TEST_CASE("branches: the graph says which executions it leaves out") {
  const std::string text = "(par (go1) (sig))(pursue (go1) (sig))";
  CHECK(gaps(unroll(prelude() + text)) ==
        Strings{"the other orders of `par`", "the other orders of `pursue`"});
  CHECK(gaps(by_turns(text)).empty());
  CHECK(gaps(unroll(prelude() + "(par (go1))")).empty());
  const auto shared = unroll(prelude() + "(let ((l (list 1))) (setf (car l) 2)) (go1)");
  REQUIRE(shared.graph->gaps.size() == 1);
  CHECK(shared.graph->gaps[0].kind == GapKind::kMeaning);
  CHECK(gaps(by_turns("(with-failure-handling ((plan-failure (e) (return))) (par (unwind-protect "
                      "(go1) (sig)) (pick)))(go2)")) ==
        Strings{"clean-ups of `par` among what follows it"});
  // One that only tells others than the robot comes unseen.
  CHECK(gaps(by_turns("(with-failure-handling ((plan-failure (e) (return))) (par (unwind-protect "
                      "(go1) (roslisp:ros-info (a b) \"over\") "
                      "(cram-occasions-events:on-event (make-instance 'robot-state-changed))) "
                      "(pick)))(go2)"))
            .empty());
}

TEST_CASE("branches: one that sleeps again and again brings nothing new") {
  const auto idle = by_turns("(pursue (go1) (loop (sleep 1)))");
  REQUIRE(idle.graph.has_value());
  CHECK(idle.terminals() == Strings{"DONE", "FAILED(navigation-pose-unreachable)", "NEVER"});
  // Counted, and asking the model each time: no cycle of branches alone.
  for (const std::string loop :
       {"(dotimes (i 5) (sleep 1))", "(loop until (holds '(open d1)) do (sleep 1))",
        "(par (loop (sleep 1)) (loop (sleep 1) (sleep 2)))"}) {
    CAPTURE(loop);
    const auto plan = by_turns("(pursue (go1) (seq " + loop + " (go2)))");
    REQUIRE(plan.graph.has_value());
    CHECK(longest_path(*plan.graph).has_value());
  }
}

TEST_CASE("branches: sleeps in a row that others cannot tell apart are one") {
  const auto sleeps = [](int count) {
    const auto branch = fmt::format("(dotimes (i {}) (sleep 1))", count);
    return by_turns("(par (seq " + branch + " (go1)) (seq " + branch + " (go2)) " + branch + ")");
  };
  const auto one = sleeps(1);
  const auto many = sleeps(200);
  REQUIRE(many.graph.has_value());
  CHECK(many.graph->branches.size() == one.graph->branches.size());
  CHECK(many.terminals() == one.terminals());
  CHECK(Ways(many).all == Ways(one).all);
  // Clean-ups of a halted branch can look at its own variable.
  const auto cleaned = by_turns(
      "(pursue (go2) (let ((n 0)) (unwind-protect (progn (sleep 1) (setf n 1) (sleep 1)) (if (= n "
      "0) "
      "(go1) (pick)))))");
  REQUIRE(cleaned.graph.has_value());
  const auto ways = Ways(cleaned).all;
  CHECK(std::any_of(ways.begin(), ways.end(),
                    [](const auto& way) { return way.find("Go(r1)") != std::string::npos; }));
  // Between these the other branch can look at the variable.
  const auto seen = by_turns(
      "(let ((k 0)) (par (dotimes (i 3) (sleep 1) (setf k i)) (seq (sleep 1) (dotimes (i k) (sig)))"
      "))");
  REQUIRE(seen.graph.has_value());
  CHECK(Ways(seen).all == std::set<std::string>{"DONE", "Signal() DONE", "Signal() Signal() DONE"});
  // The code behind the last `sleep` of a branch runs when the branch wakes up, not before.
  const auto fails = by_turns("(par (seq (sleep 1) (sleep 1) (fail 'object-unreachable)) (go1))");
  REQUIRE(fails.graph.has_value());
  CHECK(Ways(fails).all ==
        std::set<std::string>{"FAILED(object-unreachable)", "Go(r1) FAILED(object-unreachable)"});
}

TEST_CASE("branches: without turns they run in written order") {
  const auto plan = unroll(prelude() + "(par (seq (go1) (go2)) (sig))");
  CHECK(plan.codes() == Strings{"W-PAR"});
  CHECK(plan.events("+++") == Strings{"Go(r1)", "Go(r2)", "Signal()", "DONE"});
}

TEST_CASE("branches: many of them end at the limit of locations") {
  std::string text = "(par";
  for (int i = 0; i < 12; ++i) text += " " + opens(std::string(1, static_cast<char>('a' + i)), 3);
  CHECK(by_turns(text + ")").codes() == Strings{"CPL051"});
}

}  // namespace
}  // namespace parallax::compiler
