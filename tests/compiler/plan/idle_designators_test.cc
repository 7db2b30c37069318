#include <doctest/doctest.h>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

/// The text of each designator that is reported, in the order of the text.
Strings idle(const Unrolled& plan) {
  Strings out;
  for (const auto& entry : plan.sink.sorted()) {
    if (base::info(entry.code).id == "W-PERFORM") out.emplace_back(plan.files.text(*entry.range));
  }
  return out;
}

const std::string kGo = "(a motion (type going) (target *p1*))";
const std::string kSig = "(a motion (type signalling))";
const std::string kOpen = "(an action (type opening) (object (an object (name d))))";

/// GO, SIG and OPEN stand for designators.
std::string written(std::string text) {
  const std::pair<std::string, const std::string*> words[] = {
      {"GO", &kGo}, {"SIG", &kSig}, {"OPEN", &kOpen}};
  for (const auto& [word, form] : words) {
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at)) {
      text.replace(at, word.size(), *form);
      at += form->size();
    }
  }
  return "(defparameter *p1* " + pose_at(0.5) + ")\n" + text;
}

struct Idle {
  std::string plan;
  Strings reported;
};

TEST_CASE("idle designators: what is dropped is reported where it stands") {
  const Idle plans[] = {
      {"SIG", {kSig}},
      {"GO (perform SIG)", {kGo}},
      {"(progn OPEN (perform SIG))", {kOpen}},
      {"(seq SIG OPEN)", {kSig, kOpen}},
      {"(let ((x 1)) SIG (perform GO) x)", {kSig}},
      {"(par SIG (perform OPEN))", {kSig}},
      {"(par (perform SIG) OPEN)", {kOpen}},
      {"(pursue (perform SIG) OPEN)", {kOpen}},
      {"(when t SIG)(perform OPEN)", {kSig}},
      {"(unless nil SIG)(perform OPEN)", {kSig}},
      {"(if (holds '(open d)) SIG OPEN)", {kSig, kOpen}},
      {"(if (holds '(open d)) (perform SIG) OPEN)", {kOpen}},
      {"(cond ((holds '(open d)) SIG) (t (perform OPEN)))", {kSig}},
      {"(case 1 (1 SIG) (otherwise OPEN))", {kSig, kOpen}},
      {"(and t SIG)(perform OPEN)", {kSig}},
      {"(dotimes (i 2) SIG)", {kSig}},
      {"(dolist (x '(1 2)) (list x) OPEN)", {kOpen}},
      {"(loop for x in '(1 2) do SIG (perform OPEN))", {kSig}},
      {"(loop for x in '(1 2) collect OPEN)", {kOpen}},
      {"(loop for x in '(1 2) for d = OPEN do (perform SIG))", {kOpen}},
      {"(mapcar (lambda (x) (list x) OPEN) '(1 2))(perform SIG)", {kOpen}},
      {"(mapc (lambda (x) (list x) OPEN) '(1 2))(perform SIG)", {kOpen}},
      {"(list SIG OPEN)(perform SIG)", {kSig, kOpen}},
      {"(progn (cons OPEN (list 1)) (perform SIG))", {kOpen}},
      {"(let ((d OPEN)) (perform SIG))", {kOpen}},
      {"(let* ((d OPEN) (all (list d SIG))) (perform GO))", {kSig, kOpen}},
      {"(multiple-value-bind (a b) (values SIG 1) (list b))", {kSig}},
      {"(block b (when (holds '(open d)) (return-from b SIG)) (perform OPEN))", {kSig}},
      {"(with-failure-handling ((plan-failure (e) SIG)) (perform OPEN))", {kSig}},
      {"(with-failure-handling ((plan-failure (e) (return SIG))) (perform OPEN))(perform GO)",
       {kSig}},
      {"(with-failure-handling ((plan-failure (e) (retry))) OPEN (perform SIG))", {kOpen}},
      {"(let ((d OPEN)) (with-failure-handling ((plan-failure (e) (return))) (perform SIG)))",
       {kOpen}},
      {"(with-retry-counters ((n 2)) (with-failure-handling ((plan-failure (e) (do-retry n SIG "
       "(retry)))) (perform OPEN)))",
       {kSig}},
      {"(handler-case (perform SIG) (plan-failure () OPEN))", {kOpen}},
      {"(unwind-protect (perform SIG) OPEN)", {kOpen}},
      {"(try-in-order (perform SIG) OPEN)", {kOpen}},
      {"(ignore-errors SIG)(perform OPEN)", {kSig}},
      {"(with-tags (:tag a SIG))(perform OPEN)", {kSig}},
      {"(top-level SIG)(perform OPEN)", {kSig}},
      {"(make-designator :action '((:type :opening)))(perform SIG)",
       {"(make-designator :action '((:type :opening)))"}},
      // The value of the plan is nobody's.
      {"(def-top-level-cram-function main () (perform OPEN) SIG)", {kSig}},
      {"(def-cram-function step () OPEN)(def-top-level-cram-function main () (step) (perform SIG))",
       {kOpen}},
      {"(defun step () OPEN)(defun more () (step))(defun main () (more) (more) (perform SIG))",
       {kOpen}},
      {"(defun step () (return-from step OPEN))(step)(perform SIG)", {kOpen}},
      {"(flet ((step () OPEN)) (step) (perform SIG))", {kOpen}},
      {"(defun main (n) (when (> n 0) (main (- n 1))) OPEN)(main 2)", {kOpen}},
      {"(defun f (n) (if (> n 0) (g (- n 1)) OPEN))(defun g (n) (f n))(g 2)(perform SIG)", {kOpen}},
      {"(defmacro step () `OPEN)(step)(perform SIG)", {kOpen}},
      // The run does not come to it.
      {"(defun unused () SIG (perform OPEN))(perform OPEN)", {}},
  };
  for (const auto& one : plans) {
    CAPTURE(one.plan);
    auto reported = one.reported;
    const auto plan = unroll(written(one.plan));
    REQUIRE(plan.graph.has_value());
    auto found = idle(plan);
    std::sort(found.begin(), found.end());
    std::sort(reported.begin(), reported.end());
    CHECK(found == reported);
  }
}

TEST_CASE("idle designators: with branches that take turns") {
  UnrollOptions options;
  options.interleave = true;
  CHECK(idle(unroll(written("(par SIG (perform OPEN))"), options)) == Strings{kSig});
  CHECK(idle(unroll(written("(par (perform SIG) OPEN)"), options)) == Strings{kOpen});
  CHECK(idle(unroll(written("(pursue (perform SIG) OPEN)"), options)) == Strings{kOpen});
  CHECK(idle(unroll(written("(perform (par SIG (perform OPEN)))"), options)) == Strings());
  CHECK(idle(unroll(written("(perform (pursue SIG OPEN))"), options)) == Strings());
  CHECK(idle(unroll(written("(perform (par SIG OPEN))"), options)) == Strings{kOpen});
  CHECK(idle(unroll(written("(let ((d OPEN)) (par (perform d) (perform SIG)))"), options)) ==
        Strings());
}

TEST_CASE("idle designators: what may be used is not reported") {
  const std::string plans[] = {
      "(perform SIG)",
      "(let ((d OPEN)) (perform d))",
      "(let ((d OPEN)) (when (holds '(open d)) (perform d)))",
      "(let* ((a OPEN) (b a)) (perform b))",
      "(let (d) (setf d OPEN) (perform d))",
      "(let (d) (setf d OPEN) (perform SIG))",
      "(let ((d nil)) (push OPEN d) (dolist (x d) (perform x)))",
      "(defparameter *d* SIG)(perform *d*)",
      "(defparameter *d* 1)(defun f () (perform *d*))(let ((*d* SIG)) (f))",
      "(defun f (d) (perform d))(f OPEN)",
      "(defun f (d) (list d))(f OPEN)",
      "(defun f (&key d) (perform d))(f :d OPEN)",
      "(defun f (&optional (d OPEN)) (perform d))(f)",
      "(defun f (&rest all) (mapc (lambda (x) (perform x)) all))(f SIG OPEN)",
      "(defun f () OPEN)(perform (f))",
      "(defun f () OPEN)(f)(perform (f))",
      "(defun f () OPEN)(defun g () (f))(let ((d (g))) (perform d))",
      "(defun f (n) (if (> n 0) (f (- n 1)) OPEN))(perform (f 2))",
      "(defun f () OPEN)(perform (funcall #'f))",
      "(defun f () OPEN)(perform (funcall 'f))",
      "(defun f () OPEN)(f)(let ((g 'f)) (perform (funcall g)))",
      "(defun f () OPEN)(f)(dolist (g '(f)) (perform (funcall g)))",
      "(defun f (&key a b) (list a b) OPEN)(perform (f :b 1 :a 2))",
      "(defun make () OPEN)(perform SIG)",
      // Nothing calls these functions but themselves.
      "(defun f (n) (if (> n 0) (f (- n 1)) OPEN))(perform SIG)",
      "(defun f (n) (if (> n 0) (g (- n 1)) OPEN))(defun g (n) (f n))(perform SIG)",
      "(defun f (n) (if (> n 0) (funcall (lambda () (f (- n 1)))) OPEN))(perform SIG)",
      "(flet ((f () OPEN)) (perform (f)))",
      "(perform (funcall (lambda () OPEN)))",
      "(let ((f (lambda () OPEN))) (perform (funcall f)))",
      "(let ((d OPEN)) (funcall (let ((f (lambda () (perform d)))) f)))",
      "(let ((d OPEN)) (flet ((f () (perform d))) (f)))",
      "(dolist (d (list SIG OPEN)) (perform d))",
      "(mapcar (lambda (d) (perform d)) (list SIG OPEN))",
      "(let ((all (list SIG OPEN))) (perform (first all)))",
      "(let ((all (mapcar (lambda (x) (list x) OPEN) '(1 2)))) (perform (car all)))",
      "(perform (car (loop for x in '(1 2) collect OPEN)))",
      "(loop for d in (list SIG OPEN) do (perform d))",
      "(loop for x in '(1 2) for d = OPEN do (perform d))",
      "(loop for x in '(1 2) for d = OPEN do (funcall (lambda () (perform d))))",
      "(loop with d = SIG repeat 2 do (perform d))",
      "(perform (loop return OPEN))",
      "(perform (if (holds '(open d)) SIG OPEN))",
      "(perform (cond ((holds '(open d)) SIG) (t OPEN)))",
      "(perform (case 1 (1 SIG) (otherwise OPEN)))",
      "(perform (progn (perform SIG) OPEN))",
      "(perform (block b (return-from b SIG)))",
      "(perform (prog1 OPEN (perform SIG)))",
      "(perform (or (and nil SIG) OPEN))",
      "(perform (par SIG (perform OPEN)))",
      "(perform (pursue SIG (perform OPEN)))",
      "(let ((d OPEN)) (pursue (perform SIG) (perform d)))",
      "(multiple-value-bind (a b) (values SIG OPEN) (perform a) (perform b))",
      "(destructuring-bind (a &rest b) (list SIG OPEN) (perform a) (perform (car b)))",
      "(perform (with-failure-handling ((plan-failure (e) (return SIG))) (perform OPEN) GO))",
      "(let ((d OPEN)) (with-failure-handling ((plan-failure (e) (perform d) (return))) (perform "
      "SIG)))",
      "(let ((d OPEN)) (with-failure-handling ((plan-failure (e) (return))) (perform SIG)) "
      "(perform d))",
      "(let (d) (with-failure-handling ((plan-failure (e) (return))) (setf d OPEN) (perform SIG)) "
      "(when d (perform d)))",
      "(let ((d OPEN)) (unwind-protect (perform SIG) (perform d)))",
      "(let ((d OPEN)) (try-in-order (fail 'plan-failure) (perform d)))",
      "(perform (handler-case (fail 'plan-failure) (plan-failure () OPEN)))",
      "(perform (ignore-errors SIG))",
      "(perform (with-tags (:tag a SIG)))",
      "(with-designators ((d :action '((:type :opening) (:object (:name :d))))) (list d))",
      "(desig-prop-value OPEN :type)",
      "(with-desig-props (type) OPEN (list type))",
      "(if OPEN (perform SIG))",
      "(perform (make-designator :motion '((:type :signalling))))",
      "(defmacro step () `OPEN)(perform (step))",
      "(defmacro act (x) `(perform ,x))(act OPEN)",
      "(defun main () (perform SIG))",
      "'(an action (type opening))",
      "(list (an object (type cup)) (a location (on table)))",
  };
  for (const auto& text : plans) {
    CAPTURE(text);
    const auto plan = unroll(written(text));
    CHECK(plan.graph.has_value());
    CHECK(idle(plan) == Strings());
  }
}

TEST_CASE("idle designators: what the binding table and rules call gives its value to a perform") {
  const std::string binding = std::string(kBinding) + "action fetching -> plan fetch()\n";
  const std::string fetch = "(defun fetch () (perform SIG) OPEN)";
  const std::string perform = "(perform (an action (type fetching)))";
  CHECK(idle(unroll(written(fetch + perform), {}, binding)) == Strings{kOpen});
  CHECK(idle(unroll(written(fetch + "(perform " + perform + ")"), {}, binding)) == Strings());
  const std::string rule = R"(
(def-fact-group fetching (desig:action-grounding)
  (<- (desig:action-grounding ?d (fetch))
    (spec:property ?d (:type :fetching)))))";
  CHECK(idle(unroll(written(fetch + rule + perform))) == Strings());
}

TEST_CASE("idle designators: the report says what to write, and where the value goes") {
  const auto plan = unroll(written("(defun step () SIG)\n(step)"));
  REQUIRE(plan.sink.sorted().size() == 1);
  const auto entry = plan.sink.sorted().front();
  CHECK(entry.message == "nothing performs this motion designator: its value is dropped");
  CHECK(entry.fix == "write `(perform (a motion (type signalling)))`");
  REQUIRE(entry.notes.size() == 1);
  CHECK(entry.notes[0].text == "`step` returns it, and no call uses what it returns");

  const std::string long_name = "*p" + std::string(60, '1') + "*";
  const auto shortened =
      unroll("(defparameter " + long_name + " " + pose_at(0.5) + ")\n(a motion (target " +
             long_name + ") (type going))\n(perform " + kSig + ")");
  REQUIRE(shortened.sink.sorted().size() == 1);
  CHECK(shortened.sink.sorted().front().fix == "write `(perform (a motion ...))`");

  const auto macro = unroll(written("(defmacro m () `OPEN)\n(m)\n(perform SIG)"));
  REQUIRE(macro.sink.sorted().size() == 1);
  REQUIRE(macro.sink.sorted()[0].notes.size() == 1);
  CHECK(macro.files.text(*macro.sink.sorted()[0].notes[0].range) == "(m)");

  const auto packages = unroll(R"(
(defpackage a (:use cl) (:export step))
(in-package a)
(defun step () (an action (type opening) (object (an object (name d)))))
(defpackage b (:use cl a))
(in-package b)
(defun main () (step))
)");
  REQUIRE(packages.sink.sorted().size() == 1);
  CHECK(idle(packages) == Strings{kOpen});
}

TEST_CASE("idle designators: the search is bounded, and says nothing of what it did not finish") {
  constexpr int kVariables = 2000;  // each of them is followed to the end of the plan
  std::string text = "(let* (";
  for (int i = 0; i < kVariables; ++i) text += fmt::format("(d{} {})", i, kSig);
  text += ") (perform d0))";
  const auto plan = unroll(text);
  CHECK(plan.graph.has_value());
  CHECK(plan.sink.warning_count() > 0);
  CHECK(plan.sink.warning_count() < kVariables - 1);
}

}  // namespace
}  // namespace parallax::compiler
