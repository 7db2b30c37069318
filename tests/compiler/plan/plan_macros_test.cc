#include <doctest/doctest.h>

#include <string>

#include "tests/compiler/plan/plan_fixture.h"
#include "tests/compiler/plan/value_checks.h"

namespace parallax::compiler {
namespace {

TEST_CASE("macros: parameters of every kind, worked out by the standard") {
  check_values(
      {
          {"(m-opt 1)", "(1 7 nil)"},
          {"(m-opt 1 2)", "(1 2 t)"},
          {"(m-key 1 :b 5)", "(1 nil 5)"},
          {"(m-key 1 :b 5 :a 3)", "(1 3 5)"},
          {"(m-nest (1 (2 3)) 4 5)", "(1 2 3 (4 5))"},
          {"(m-dot 1 2 3)", "(1 (2 3))"},
          {"(m-whole 1 2)", "(m-whole 1 2)"},
          {"(m-aux 3)", "(3 4)"},
          {"(my-let (x 1 y 2) (list y x))", "(2 1)"},
      },
      R"(
(defmacro m-opt (a &optional (b 7 given)) `(list ,a ,b ,given))
(defmacro m-key (a &key ((:a first)) b) `(list ,a ,first ,b))
(defmacro m-nest ((a (b c)) &rest more) `(list ,a ,b ,c (list ,@more)))
(defmacro m-dot (a . more) `(list ,a ',more))
(defmacro m-whole (&whole w &rest r) (declare (ignore r)) `',w)
(defmacro m-aux (a &aux (b (+ a 1))) `(list ,a ,b))
(defmacro my-let (pairs &body body)
  `(let ,(loop for (name value) on pairs by #'cddr collect (list name value)) ,@body))
)");
}

TEST_CASE("macros: bodies are Lisp over data; templates nest") {
  check_values(
      {
          {"(twice (list 1))", "((1) (1))"},
          {"(rev + 3 2 10)", "15"},
          {"(let ((x 5)) (swap-list x 2))", "(2 5)"},
          {"(my-or nil 3 (fail 'plan-failure))", "3"},
          {"(make-adder-form 3 4)", "7"},
          {"(square (+ 1 2))", "9"},
          {"(let ((n 0)) (square (incf n)) n)", "1"},
          {"(name-of foo)", "\"FOO\""},
          {"(get-red)", "red"},
          {"(macrolet ((two (x) `(list ,x ,x))) (two 'a))", "(a a)"},
          {"(macrolet ((k () 1)) (macrolet ((k () 2)) (k)))", "2"},
          {"(flet ((twice (x) (list 'mine x))) (twice 1))", "(mine 1)"},
          {"(counted a b c)", "3"},
      },
      R"(
(defun pair (x) (list x x))
(defmacro twice (form) (cons 'list (pair form)))
(defmacro rev (&rest forms) (let ((all (reverse forms))) `(,(car (last all)) ,@(butlast all))))
(defmacro swap-list (a b) (let ((g (gensym))) `(let ((,g ,a)) (list ,b ,g))))
(defmacro my-or (&rest forms)
  (if (null (cdr forms))
      (car forms)
      (let ((value (gensym "value")))
        `(let ((,value ,(car forms))) (if ,value ,value (my-or ,@(cdr forms)))))))
(defmacro def-adder (name) `(defmacro ,name (a b) `(+ ,a ,b)))
(def-adder make-adder-form)
(defmacro square (x) (once-only (x) `(* ,x ,x)))
(defmacro name-of (symbol) (symbol-name symbol))
(defmacro def-colour (colour)
  `(defun ,(intern (format nil "GET-~a" colour)) () ',colour))
(def-colour red)
(defmacro counted (&rest items)
  (labels ((size (list) (if list (+ 1 (size (cdr list))) 0))) (size items)))
)");
}

TEST_CASE("macros: what they hand on stands where the plan wrote it") {
  const auto plan = with_prelude(R"(
(defmacro with-signal (&body body)
  `(progn (sig) ,@body))
(defun run ()
  (with-signal
    (go1)
    (perform (a motion (type going) (target *p2*)))))
(run))");
  CHECK(plan.events("+++") == Strings{"Signal()", "Go(r1)", "Go(r2)", "DONE"});
  const auto& last = plan.graph->locations[LocationId(2)];
  CHECK(plan.files[last.source.file].text(last.source) ==
        "(perform (a motion (type going) (target *p2*)))");
}

TEST_CASE("macros: an error in an expansion shows the macro's text and the call") {
  const auto plan = unroll("(defmacro m (x)\n  `(list ,x\n         (nonesuch 1)))\n(m 2)");
  const auto entries = plan.sink.sorted();
  REQUIRE(entries.size() == 1);
  CHECK(entries[0].message == "no form or function `nonesuch`");
  CHECK(plan.files[entries[0].range->file].position(entries[0].range->begin).line == 3);
  REQUIRE(entries[0].notes.size() >= 1);
  CHECK(entries[0].notes[0].text == "in the expansion of this call of `m`");
  CHECK(plan.files[entries[0].range->file].text(*entries[0].notes[0].range) == "(m 2)");

  const auto value = unroll("(defmacro m (x)\n  `(car ,x))\n(m 2)");
  REQUIRE(value.sink.sorted().size() == 1);
  CHECK(value.sink.sorted()[0].notes.at(0).text == "in the expansion of this call of `m`");

  const auto own = unroll("(defmacro m (x)\n  (car x))\n(m 2)");
  REQUIRE(own.sink.sorted().size() == 1);
  CHECK(own.sink.sorted()[0].message == "`car`: argument 1 is 2, not a list");
  CHECK(own.sink.sorted()[0].notes.at(0).text == "while `m` is expanded here");
}

TEST_CASE("macros: wrong calls and wrong macros have their place") {
  check_refused({
      {"(defmacro m (a b) (list 'list a b))\n(m 1)", "CPL008", "2:1",
       "`m`: the pattern has 2 parts, the list 1"},
      {"(defmacro m (a &key b) (list 'list a b))\n(m 1 :c 2)", "CPL008", "2:1",
       "`m`: unexpected argument `:c`"},
      {"(defmacro m (a &optional b) (list 'list a b))\n(m 1 2 3)", "CPL008", "2:1",
       "`m`: the list has 1 parts more than the pattern"},
      {"(defun f () (m))\n(defmacro m () 1)", "CPL053", "1:13",
       "macro `m`: it is used above its definition"},
      {"(defmacro m () (helper))\n(m)\n(defun helper () 1)", "CPL053", "2:1",
       "macro `m`: its expansion calls `helper`, which is defined below"},
      {"(defun f () (m))\n(defmacro k () 1)(defmacro m () (k))\n(f)", "CPL053", "1:13",
       "macro `m`: it is used above its definition"},
      {"(defmacro m () (error \"no\"))\n(m)", "CPL053", "2:1",
       "macro `m`: its expansion fails with `simple-error`"},
      {"(defmacro m () (perform (a motion (type signalling))))\n(m)", "CPL053", "2:1",
       "macro `m`: it performs while it is expanded; quote what is to be performed"},
      {"(defmacro m () (holds '(f)))\n(m)", "CPL053", "2:1",
       "macro `m`: it asks the model while it is expanded; quote the question"},
      {"(defmacro m () (list 'list (lambda (x) x)))\n(m)", "CPL053", "2:1",
       "macro `m`: its expansion contains a function, which is no code"},
      {"(defmacro m (x) `(list ,@x . 1))\n(m (2))", "CPL003", "1:18",
       "malformed `list`: a dotted list is data: quote it"},
      {"(defmacro m () 1)\n(defmacro m () 2)\n(m)", "CPL005", "2:11", "`m` is defined twice"},
      {"(defvar *x* (+ 1 1))\n(defmacro m () *x*)\n(m)", "CPL004", "2:16",
       "no variable `*x*` here"},
  });
}

TEST_CASE("macros: a global that is written out is known to them") {
  check_values({{"(m)", "(5 5)"}, {"(m :n 2)", "(2 5)"}},
               "(defparameter *n* 5)(defmacro m (&key (n *n*)) `(list ,n *n*))");
}

TEST_CASE("macros: packages have their own") {
  const auto plan = unroll(prelude() + R"(
(defpackage :one (:export #:act))
(defpackage :two (:export #:act))
(in-package :one)
(defmacro act () '(helper))
(defun helper () (common-lisp-user::go1))
(in-package :two)
(defmacro act () '(helper))
(defun helper () (common-lisp-user::go2))
(in-package :common-lisp-user)
(one:act)
(two:act)
)");
  CHECK(plan.codes() == Strings{});
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("++") == Strings{"Go(r1)", "Go(r2)", "DONE"});
}

TEST_CASE("macros: what has no end is one message") {
  const std::vector<std::string> endless = {
      "(defmacro m () '(m))(defun f () (m))(f)",
      "(defmacro m () '(m))(m)",
      "(defmacro m () '(progn (m) (m)))(m)",
      "(defmacro m () '(progn (m) (m)))(defun f () (m))(f)",
      "(defmacro m (x) `(m (,x ,x)))(m a)",
      "(defmacro m (x) `(m (m ,x)))(defun f () (m a))(f)",
      "(defmacro m (&rest x) `(m ,@x ,@x))(defun f () (m a))(f)",
      "(defmacro m () (let ((x 'a)) (dotimes (i 5000 x) (setf x (list 'progn x)))))(m)",
      "(defmacro m () (let ((x 'a)) (dotimes (i 60 x) (setf x (list 'progn x x)))))(m)",
      "(defmacro m () (loop))(m)",
      "(defmacro m () (let ((x nil)) (loop (push 1 x))))(m)",
      "(defun f (x) (f x))(defmacro m () (f 1))(m)",
      "(defmacro m () `(macrolet ((m () '(m))) (m)))(m)",
  };
  for (const auto& text : endless) {
    CAPTURE(text);
    const auto plan = unroll(text);
    CHECK(!plan.graph.has_value());
    CHECK(plan.codes().size() == 1);
  }
}

TEST_CASE("macros: expansions do not depend on what was expanded before") {
  const std::string text = prelude() +
                           "(defmacro m (x) (let ((g (gensym))) `(let ((,g ,x)) (when ,g (go1)))))"
                           "(defun f (x) (m x) (m (not x)))(f t)(f nil)";
  const auto first = unroll(text);
  const auto second = unroll(text);
  REQUIRE(first.graph.has_value());
  REQUIRE(second.graph.has_value());
  CHECK(dump_text(*first.graph, first.files) == dump_text(*second.graph, second.files));
}

}  // namespace
}  // namespace parallax::compiler
