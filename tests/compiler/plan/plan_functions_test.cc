#include <doctest/doctest.h>

#include <string>

#include "tests/compiler/plan/plan_fixture.h"
#include "tests/compiler/plan/value_checks.h"

namespace parallax::compiler {
namespace {

TEST_CASE("functions as values: what the standard says they return") {
  check_values(
      {
          {"(let ((f #'twice)) (funcall f 3))", "6"},
          {"(let ((f (lambda (x &optional (y 2)) (list x y)))) (funcall f 1))", "(1 2)"},
          {"(funcall 'twice 4)", "8"},
          {"(let ((f 'twice)) (funcall f 4))", "8"},
          {"(apply #'keyed '(1 :b 2))", "(1 nil 2)"},
          {"(apply 'keyed 1 '(:a 5))", "(1 5 nil)"},
          {"(apply #'rest-of 1 2 '(3 4))", "(1 (2 3 4))"},
          {"(apply #'max '(3 9 2))", "9"},
          {"(funcall (if t #'+ #'-) 5 3)", "8"},
          {"(let ((n 10)) (let ((f (lambda (x) (+ x n)))) (funcall f 1)))", "11"},
          {"(let ((n 10)) (let ((f (lambda (x) (+ x n)))) (setf n 20) (funcall f 1)))", "21"},
          {"(let ((n 0)) (let ((f (lambda () (incf n)))) (funcall f) (funcall f) n))", "2"},
          {"(funcall (adder 3) 4)", "7"},
          {"(mapcar (adder 1) '(1 2))", "(2 3)"},
          {"(mapcar #'funcall-it (mapcar (lambda (n) (lambda () n)) '(1 2 3)))", "(1 2 3)"},
          {"(funcall (funcall (lambda (x) (lambda (y) (list x y))) 1) 2)", "(1 2)"},
          {"(flet ((f (x) (* x 2))) (mapcar #'f '(1 2)))", "(2 4)"},
          {"(labels ((f (l) (if l (cons (car l) (f (cdr l))) nil))) (funcall #'f '(1 2)))",
           "(1 2)"},
          {"(block out (mapc (lambda (x) (when (> x 1) (return-from out x))) '(1 2 3)) 'no)", "2"},
          {"(block out (funcall-with (lambda () (return-from out 'left))) 'no)", "left"},
          {"(functionp #'car)", "t"},
          {"(functionp 'car)", "nil"},
          {"(let ((fs (list #'car #'cdr))) (funcall (second fs) '(1 2)))", "(2)"},
          {"(funcall *keep* 5)", "(5)"},
          {"(funcall (curry #'list 1) 2)", "(1 2)"},
          {"(funcall (rcurry #'list 1) 2)", "(2 1)"},
          {"(funcall (complement #'null) nil)", "nil"},
          {"(funcall (constantly 3) 1 2)", "3"},
          {"(let ((log nil)) (keyed (push 1 log) :b (push 2 log) :a (push 3 log)) (reverse log))",
           "(1 2 3)"},
      },
      R"(
(defun twice (x) (* 2 x))
(defun keyed (x &key a b) (list x a b))
(defun rest-of (x &rest more) (list x more))
(defun adder (n) (lambda (x) (+ x n)))
(defun funcall-it (f) (funcall f))
(defun funcall-with (f) (funcall f))
(defparameter *keep* #'list)
)");
}

TEST_CASE("functions as values: searches, filters, folds and sorting") {
  check_values({
      {"(find-if #'evenp '(1 2 3 4))", "2"},
      {"(find-if #'evenp '(1 2 3 4) :from-end t)", "4"},
      {"(find-if (lambda (x) (> x 1)) '((0 a) (2 b)) :key #'car)", "(2 b)"},
      {"(find-if-not #'numberp '(1 a))", "a"},
      {"(find 'b '((a 1) (b 2)) :key #'first)", "(b 2)"},
      {"(find \"x\" '(\"y\" \"x\") :test #'string=)", "\"x\""},
      {"(find 3 '(1 5 2) :test #'<)", "5"},
      {"(position 'c '(a b c))", "2"},
      {"(position 'z '(a b c))", "nil"},
      {"(position-if #'evenp '(1 2 4) :from-end t)", "2"},
      {"(position 1 '(1 0 1) :start 1)", "2"},
      {"(count-if #'oddp '(1 2 3))", "2"},
      {"(count 'a '(a b a))", "2"},
      {"(remove-if #'oddp '(1 2 3 4))", "(2 4)"},
      {"(remove-if-not #'oddp '(1 2 3 4))", "(1 3)"},
      {"(remove 1 '(1 2 1 3) :count 1)", "(2 1 3)"},
      {"(remove 1 '(1 2 1 3) :count 1 :from-end t)", "(1 2 3)"},
      {"(remove 'a '((a 1) (b 2)) :key #'car)", "((b 2))"},
      {"(remove 2 '(1 2 3) :test #'<)", "(1 2)"},
      {"(remove-duplicates '(1 2 1 3 2))", "(1 3 2)"},
      {"(remove-duplicates '((a 1) (b 1) (a 2)) :key #'car)", "((b 1) (a 2))"},
      {"(member 2 '(1 2 3) :test #'<)", "(3)"},
      {"(member 'b '((a) (b) (c)) :key #'car)", "((b) (c))"},
      {"(member-if #'evenp '(1 2 3))", "(2 3)"},
      {"(assoc \"b\" '((\"a\" . 1) (\"b\" . 2)) :test #'equal)", "(\"b\" . 2)"},
      {"(assoc-if #'evenp '((1 a) (2 b)))", "(2 b)"},
      {"(rassoc 2 '((a . 1) (b . 2)))", "(b . 2)"},
      {"(reduce #'+ '(1 2 3 4))", "10"},
      {"(reduce #'+ nil)", "0"},
      {"(reduce #'list '(1 2 3))", "((1 2) 3)"},
      {"(reduce #'list '(1 2 3) :from-end t)", "(1 (2 3))"},
      {"(reduce #'list '(1 2) :initial-value 0)", "((0 1) 2)"},
      {"(reduce #'cons '(1 2) :from-end t :initial-value nil)", "(1 2)"},
      {"(reduce #'max '((1 a) (5 b) (3 c)) :key #'first)", "5"},
      {"(sort '(3 1 2) #'<)", "(1 2 3)"},
      {"(sort (list '(b 2) '(a 1)) #'< :key #'second)", "((a 1) (b 2))"},
      {"(stable-sort '((1 a) (0 b) (1 c) (0 d)) #'< :key #'car)", "((0 b) (0 d) (1 a) (1 c))"},
      {"(sort (loop for i from 1 to 40 collect (mod (* 7 i) 41)) #'<)",
       "(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32 33 "
       "34 35 36 37 38 39 40)"},
      {"(every #'< '(1 2) '(2 3))", "t"},
      {"(every #'identity '(1 2))", "t"},
      {"(some #'> '(1 2) '(2 1))", "t"},
      {"(notany #'oddp '(2 4))", "t"},
      {"(notevery #'oddp '(1 2))", "t"},
      {"(mapcar #'+ '(1 2 3) '(10 20))", "(11 22)"},
      {"(mapcar (lambda (&rest all) all) '(1 2) '(a b))", "((1 a) (2 b))"},
      {"(mapcan (lambda (x) (if (oddp x) (list x x) nil)) '(1 2 3))", "(1 1 3 3)"},
      {"(let ((l nil)) (mapc (lambda (a b) (push (list a b) l)) '(1 2) '(x y)) l)",
       "((2 y) (1 x))"},
      {"(mapc #'list '(1 2))", "(1 2)"},
      {"(union '(1 2) '(2 3))", "(1 2 3)"},
      {"(intersection '(1 2 3) '(3 1))", "(1 3)"},
      {"(set-difference '(1 2 3) '(2))", "(1 3)"},
      {"(subsetp '(1 2) '(3 2 1))", "t"},
      {"(adjoin 'a '(a b))", "(a b)"},
      {"(adjoin \"a\" '(\"a\") :test #'string=)", "(\"a\")"},
      {"(let ((l '(a))) (pushnew 'a l) (pushnew 'b l) l)", "(b a)"},
      {"(let ((l '(1 2))) (list (pop l) (pop l) (pop l) l))", "(1 2 nil nil)"},
  });
}

TEST_CASE("functions as values: they perform, and keep what they saw") {
  const auto plan = with_prelude(R"(
(defun act-twice (action) (funcall action) (funcall action))
(let ((actions (list #'go1 (lambda () (sig)))))
  (dolist (action actions) (act-twice action)))
)");
  CHECK(plan.events("++++") == Strings{"Go(r1)", "Go(r1)", "Signal()", "Signal()", "DONE"});

  // A function in a variable across performs; a counter that it shares with its caller.
  const auto shared = with_prelude(R"(
(let* ((n 0) (next (lambda () (incf n) n)))
  (go1)
  (funcall next)
  (go2)
  (when (= (funcall next) 2) (sig)))
)");
  CHECK(shared.events("+++") == Strings{"Go(r1)", "Go(r2)", "Signal()", "DONE"});

  const auto found = with_prelude(R"(
(find-if (lambda (?where)
           (handler-case (progn (perform (a motion (type going) (target ?where))) t)
             (plan-failure () nil)))
         (list *p1* *p2*))
)");
  CHECK(found.events("+") == Strings{"Go(r1)", "DONE"});
  CHECK(found.events("-+") == Strings{"Go(r1)", "Go(r2)", "DONE"});
  CHECK(found.events("--") == Strings{"Go(r1)", "Go(r2)", "DONE"});
}

TEST_CASE("functions as values: equal states with functions are one location") {
  const auto plan = with_prelude("(let ((f (lambda () (go1)))) (loop (funcall f) (sig)))");
  CHECK(plan.graph->locations.size() == 2);
  CHECK(plan.walk("+++") == "L0 L1 L0 L1");
}

TEST_CASE("functions as values: wrong uses are located") {
  check_refused({
      {"(defun f (x) x)\n(let ((g #'f)) (funcall g))", "CPL007", "2:16", "`f`: no value for `x`"},
      {"(defun f (x) x)\n(let ((g #'f)) (funcall g 1 2))", "CPL007", "2:16",
       "`f`: unexpected argument 2"},
      {"(defun f (&key x) x)\n(let ((g #'f)) (funcall g :y 2))", "CPL007", "2:16",
       "`f`: unexpected argument :y"},
      {"(defun f (&key x) x)\n(let ((g #'f)) (funcall g :x))", "CPL007", "2:16",
       "`f`: unexpected argument :x"},
      {"(let ((g 3)) (funcall g))", "CPL008", "1:14",
       "`funcall`: 3 is called, which is no function"},
      {"(funcall :key 1)", "CPL008", "1:1", "`funcall`: :key is called, which is no function"},
      {"(let ((g 'nonesuch)) (funcall g))", "CPL010", "1:22", "no form or function `nonesuch`"},
      {"(funcall #'nonesuch)", "CPL010", "1:12", "no form or function `nonesuch`"},
      {"(sort '(1 a) #'<)", "CPL008", "1:1", "`sort`: argument 1 is a, not a number"},
      {"(find-if #'car '(1))", "CPL008", "1:1", "`find-if`: argument 1 is 1, not a list"},
      {"(find-if 5 '(1))", "CPL008", "1:1", "`find-if`: 5 is called, which is no function"},
      {"(reduce #'+ 5)", "CPL008", "1:1", "`reduce`: argument 1 is 5, not a list"},
      {"(find-if #'car)", "CPL007", "1:1", "`find-if`: no value for `list`"},
      {"(defun f () (let ((n 0)) (lambda () (incf n))))\n(funcall (f))", "CPL013", "1:13",
       "`let` is not in the subset here: a function outlives what it shares with the code around "
       "it: variables that change, local functions or blocks; keep it inside, or let it use "
       "variables that nothing changes"},
  });
}

}  // namespace
}  // namespace parallax::compiler
