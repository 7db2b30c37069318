#include <doctest/doctest.h>

#include <string>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

Strings codes(const std::string& text, const std::string& entry = "") {
  UnrollOptions options;
  if (!entry.empty()) options.entry = entry;
  return unroll(prelude() + text, options).codes();
}

TEST_CASE("reach: what the run cannot come to is not refused") {
  const std::string unknown = "(defun calibrate () (read-camera))";
  CHECK(codes(unknown + "(go1)").empty());
  CHECK(codes(unknown + "(defun main () (go1))").empty());
  CHECK(codes("(defun main () (go1))" + unknown, "main").empty());
  CHECK(codes("(defparameter *camera* (open-camera))(defmacro seen () (look))(go1)").empty());
  // Forms at top level do not run where a function is the entry.
  CHECK(codes("(defun main () (go1))(start-node)", "main").empty());
}

TEST_CASE("reach: calls, data, globals and macros lead on") {
  const std::string unknown = "(defun calibrate () (read-camera))";
  CHECK(codes(unknown + "(calibrate)") == Strings{"CPL010"});
  CHECK(codes(unknown + "(defun main () (go1) (when nil (calibrate)))") == Strings{"CPL010"});
  CHECK(codes(unknown + "(defun main () (funcall 'calibrate))") == Strings{"CPL010"});
  CHECK(codes(unknown + "(defun main () (funcall #'calibrate))") == Strings{"CPL010"});
  CHECK(codes(unknown + "(defparameter *step* #'calibrate)(defun main () (funcall *step*))") ==
        Strings{"CPL010"});
  CHECK(codes(unknown + "(defmacro twice (x) `(progn (calibrate) ,x))(twice (go1))") ==
        Strings{"CPL010"});
}

TEST_CASE("reach: everything that is reached is reported in one run") {
  CHECK(
      codes("(defun f () (read-camera) (g))(defun g () (open-door 1 2))(defun h () (unseen))(f)") ==
      Strings{"CPL010", "CPL010"});
}

TEST_CASE("reach: a rule counts if the type of its actions is named") {
  const std::string rules =
      "(def-fact-group plans (action-grounding)"
      "  (<- (action-grounding ?d (fetch)) (property ?d (:type :fetching)))"
      "  (<- (action-grounding ?d (wash)) (property ?d (:type :washing))))"
      "(defun fetch (&key &allow-other-keys) (pick))"
      "(defun wash (&key &allow-other-keys) (turn-tap))";
  CHECK(codes(rules + "(perform (an action (type fetching)))").empty());
  CHECK(codes(rules + "(perform (an action (type washing)))") == Strings{"CPL010"});
  // Through data, and through a predicate of the rule.
  CHECK(codes(rules + "(dolist (?k '(:fetching :washing)) (perform (an action (type ?k))))") ==
        Strings{"CPL010"});
  const std::string helper =
      "(def-fact-group plans (action-grounding)"
      "  (<- (action-grounding ?d (fetch)) (property ?d (:type :fetching)) (ready ?_))"
      "  (<- (ready ?x) (lisp-fun warm-up ?x)))"
      "(defun warm-up () (turn-tap))(defun fetch (&key &allow-other-keys) (pick))";
  CHECK(codes(helper + "(perform (an action (type fetching)))") == Strings{"CPL010"});
  CHECK(codes(helper + "(go1)").empty());
}

TEST_CASE("reach: what a slot begins with counts where the slot is read") {
  const std::string lost =
      "(define-condition lost (plan-failure)"
      " ((place :initarg :place :initform (usual-place) :reader place-of)))"
      "(defun usual-place () *p2*)";
  const std::string asks =
      "(with-failure-handling ((lost (e) (let ((?p (place-of e)))"
      " (perform (a motion (type going) (target ?p)))) (return))) (fail 'lost))";
  const auto plan = unroll(prelude() + lost + asks);
  CHECK(plan.codes().empty());
  CHECK(plan.events("+") == Strings{"Go(r2)", "DONE"});
  const std::string broken = lost + "(defun unused () (read-camera))";
  CHECK(codes(broken + asks).empty());
  const std::string camera =
      "(define-condition lost (plan-failure) ((place :initform (seen) :reader place-of)))"
      "(defun seen () (read-camera))";
  CHECK(codes(camera + "(go1)").empty());
  CHECK(codes(camera + asks) == Strings{"CPL010"});
}

TEST_CASE("reach: functions of the binding table count") {
  const std::string plan = prelude() + "(defun fetch () (turn-tap))(go1)";
  CHECK(unroll(plan, {}, std::string(kBinding) + "action fetching -> plan fetch()\n").codes() ==
        Strings{"CPL010"});
}

TEST_CASE("reach: a name that the plan puts together is reported where it is called") {
  CHECK(codes("(defun calibrate () (go1))(defun main () (funcall (intern \"calibrate\")))") ==
        Strings{"CPL010"});
}

}  // namespace
}  // namespace parallax::compiler
