#include <doctest/doctest.h>

#include <string>

#include "tests/compiler/plan/plan_fixture.h"
#include "tests/compiler/plan/value_checks.h"

namespace parallax::compiler {
namespace {

TEST_CASE("Lisp: several values go where the standard sends them") {
  check_values(
      {
          {"(multiple-value-bind (a b) (two) (list a b))", "(1 2)"},
          {"(multiple-value-bind (a b c) (two) (list a b c))", "(1 2 nil)"},
          {"(multiple-value-bind (a) (two) a)", "1"},
          {"(multiple-value-bind (a b) 5 (list a b))", "(5 nil)"},
          {"(multiple-value-bind (a b) (none) (list a b))", "(nil nil)"},
          {"(list (two) (none))", "(1 nil)"},
          {"(let ((x (two))) (multiple-value-list x))", "(1)"},
          {"(let ((x 0)) (multiple-value-list (setf x (two))))", "(1)"},
          {"(multiple-value-list (if t (two) 3))", "(1 2)"},
          {"(multiple-value-list (let ((x 1)) (progn x (two))))", "(1 2)"},
          {"(multiple-value-list (block b (return-from b (two))))", "(1 2)"},
          {"(multiple-value-list (unwind-protect (two) 7))", "(1 2)"},
          {"(multiple-value-list (handler-case (two) (error () 1)))", "(1 2)"},
          {"(multiple-value-list (funcall #'two))", "(1 2)"},
          {"(multiple-value-list (prog1 (two) 3))", "(1)"},
          {"(multiple-value-list (multiple-value-prog1 (two) 3))", "(1 2)"},
          {"(multiple-value-list (values))", "nil"},
          {"(multiple-value-list (values-list '(1 2 3)))", "(1 2 3)"},
          {"(multiple-value-call #'list (two) 5 (two))", "(1 2 5 1 2)"},
          {"(let (a b) (multiple-value-setq (a b) (two)) (list a b))", "(1 2)"},
          {"(nth-value 1 (two))", "2"},
          {"(nth-value 2 (two))", "nil"},
          {"(multiple-value-list (floor 7 2))", "(3 1)"},
          {"(multiple-value-list (floor -7 2))", "(-4 1)"},
          {"(list (truncate -7 2) (ceiling 7 2) (round 5 2) (round 7 2) (mod -7 3) (rem -7 3))",
           "(-3 4 2 4 2 -1)"},
          {"(multiple-value-bind (a b) (task) (list a b))", "(3 4)"},
          {"(if (none) 1 2)", "2"},
          {"(or (none) (two))", "1"},
          {"(multiple-value-list (when t (two)))", "(1 2)"},
      },
      "(defun two () (values 1 2))(defun none () (values))"
      "(def-cram-function task () (values 3 4))");
}

TEST_CASE("Lisp: parts of lists and designators are places") {
  check_values({
      {"(let ((l (list :b 1)) (v 7)) (rotatef (getf l :a 9) v) (list v (getf l :a)))", "(9 7)"},
      {"(let ((l nil)) (list (shiftf (getf l :n 4) 5) (getf l :n)))", "(4 5)"},
      {"(let ((l nil)) (incf (getf l :n 0)) (push 3 (getf l :m '(1))) l)", "(:n 1 :m (3 1))"},
      {"(let ((l (list 1 2))) (push 3 (cdr (last l))) l)", "(1 2 3)"},
      {"(let ((l (list 1 2 3))) (setf (car (last l)) 5) l)", "(1 2 5)"},
      {"(let ((l (list (list :a 1) (list :b 2)))) (setf (cadr (find :b l :key #'car)) 5) l)",
       "((:a 1) (:b 5))"},
      {"(let ((l (list (list :a 1) (list :b 2)))) (incf (cadr (assoc :a l))) l)",
       "((:a 2) (:b 2))"},
      // Operands are computed once, in written order.
      {"(let ((n 0) (l (list 1 2 3))) (incf (nth (incf n) l) 10) (list n l))", "(1 (1 12 3))"},
      {"(let ((n 0) (l nil)) (incf (getf l (if (= (incf n) 1) :a :b) (incf n))) (list n l))",
       "(2 (:a 3))"},
      {"(let ((d (desig:a location (arm left) (n 1)))) "
       "(setf (cadr (find :arm (desig:description d) :key #'car)) :right) (desig:properties d))",
       "((:arm :right) (:n 1))"},
  });
}

TEST_CASE("Lisp: texts") {
  check_values({
      {"(string-capitalize \"a-bc d2e\")", "\"A-Bc D2e\""},
      {"(list (string-trim \" .\" \" a b. \") (string-left-trim \"x\" \"xxa\") "
       "(string-right-trim \"x\" \"axx\") (string-trim \"x\" \"xx\"))",
       "(\"a b\" \"a\" \"a\" \"\")"},
      {"(list (string< \"ab\" \"ac\") (string< \"b\" \"a\") (string> \"b\" \"a\") "
       "(string< \"a\" \"ab\"))",
       "(1 nil 0 1)"},
      {"(list (parse-integer \"12\") (parse-integer \"-3\"))", "(12 -3)"},
      {"(handler-case (parse-integer \"1.5\") (error () 'e))", "e"},
  });
}

TEST_CASE("Lisp: iterate") {
  check_values({
      {"(iter (for x in '(1 2 3)) (collect (* x x)))", "(1 4 9)"},
      {"(iter (for i from 1 to 4) (when (oddp i) (collect i)))", "(1 3)"},
      {"(iter (for i below 4) (with n = 10) (incf n i) (finally (return n)))", "16"},
      {"(iterate (for (a b) in '((1 2) (3 4))) (sum (+ a b)))", "10"},
      {"(iter (for x in-vector (vector 1 5 2)) (maximizing x))", "5"},
      {"(iter (for x in '(1 2 3)) (finding x such-that (evenp x)))", "2"},
      {"(let ((h (make-hash-table))) (setf (gethash 1 h) 2) "
       "(iter (for (k v) in-hashtable h) (collect (list k v))))",
       "((1 2))"},
      {"(iter (for x initially 1 then (* 2 x)) (while (< x 9)) (collect x))", "(1 2 4 8)"},
  });
}

TEST_CASE("Lisp: functions of real numbers, and types that are said") {
  check_values({
      {"(list (sqrt 4) (expt 2 10) (expt 2 -1) (expt 0.5 2))", "(2.0 1024 1/2 0.25)"},
      {"(list (atan 0) (atan 0 1) (sin 0) (cos 0) (exp 0))", "(0.0 0.0 0.0 1.0 1.0)"},
      {"(list (signum -3) (signum 0) (signum 2.5))", "(-1 0 1.0)"},
      {"(< 3.141 (* 4 (atan 1)) 3.142)", "t"},
      {"(the integer (+ 1 1))", "2"},
      {"(handler-case (the string 1) (type-error () 'e))", "e"},
      {"(the a-type-of-others 1)", "1"},
      {"(locally (declare (optimize speed)) 1 2)", "2"},
  });
  check_refused({{"(sqrt -1)", "CPL008", "1:1",
                  "`sqrt`: argument 1 is -1, not a number for which it is real and finite"}});
}

TEST_CASE("Lisp: types") {
  check_values({
      {"(mapcar #'listp '(nil (1) a))", "(t t nil)"},
      {"(mapcar #'consp '(nil (1)))", "(nil t)"},
      {"(mapcar #'atom '(nil (1) a 1))", "(t nil t t)"},
      {"(mapcar #'symbolp '(nil a :a \"a\"))", "(t t t nil)"},
      {"(mapcar #'keywordp '(nil a :a))", "(nil nil t)"},
      {"(mapcar #'integerp '(1 1.0 1/2))", "(t nil nil)"},
      {"(mapcar #'floatp '(1 1.0))", "(nil t)"},
      {"(typep 1 '(or string integer))", "t"},
      {"(typep nil '(and list symbol))", "t"},
      {"(typep nil '(not cons))", "t"},
      {"(typep 'b '(member a b))", "t"},
      {"(typep 3 '(eql 3))", "t"},
      {"(typep 3 '(integer 0 2))", "nil"},
      {"(typep 3 '(integer 0 *))", "t"},
      {"(typep t 'boolean)", "t"},
      {"(typep #'car 'function)", "t"},
      {"(handler-case (fail 'object-unfetchable) (plan-failure (e) (typep e 'high-level-failure)))",
       "t"},
      {"(handler-case (fail 'object-unfetchable) (plan-failure (e) (typep e 'low-level-failure)))",
       "nil"},
      {"(typecase 1 (string 's) ((or float integer) 'n) (t 'x))", "n"},
      {"(typecase 'a (string 's) (otherwise 'x))", "x"},
      {"(typecase 'a (string 's))", "nil"},
      {"(handler-case (etypecase 'a (string 's)) (error () 'e))", "e"},
      {"(handler-case (check-type 1 string) (error () 'e))", "e"},
      {"(check-type \"a\" string)", "nil"},
      {"(handler-case (assert (= 1 2)) (plan-failure () 'p) (error () 'e))", "e"},
      {"(assert (= 1 1))", "nil"},
      {"(ignore-errors (error \"no\") 1)", "nil"},
      {"(ignore-errors 1 2)", "2"},
      {"(handler-case (ignore-errors (fail 'plan-failure)) (plan-failure () 'out))", "out"},
      {"(block b (handler-bind ((plan-failure (lambda (e) (return-from b 'handled)))) "
       "(fail 'object-unfetchable)))",
       "handled"},
      {"(let ((n 0)) (handler-case (handler-bind ((plan-failure (lambda (e) (incf n)))) "
       "(fail 'object-unfetchable)) (plan-failure () n)))",
       "1"},
  });
}

TEST_CASE("Lisp: lists, names and texts") {
  check_values({
      {"(subseq '(a b c d) 1 3)", "(b c)"},
      {"(subseq \"abcd\" 2)", "\"cd\""},
      {"(elt '(a b) 1)", "b"},
      {"(nthcdr 2 '(a b c))", "(c)"},
      {"(last '(a b c) 2)", "(b c)"},
      {"(butlast '(a b c))", "(a b)"},
      {"(list* 1 2 '(3))", "(1 2 3)"},
      {"(getf '(:a 1 :b 2) :b)", "2"},
      {"(getf '(:a 1) :c 9)", "9"},
      {"(make-list 2 :initial-element 'x)", "(x x)"},
      {"(copy-list '(1 2))", "(1 2)"},
      {"(acons 'a 1 nil)", "((a . 1))"},
      {"(cddr '(1 2 3))", "(3)"},
      {"(cadar '((1 2)))", "2"},
      {"(symbol-name 'foo-bar)", "\"FOO-BAR\""},
      {"(intern \"FOO\")", "foo"},
      {"(intern \"LEFT\" :keyword)", ":left"},
      {"(string 'abc)", "\"ABC\""},
      {"(string= \"ab\" \"ab\")", "t"},
      {"(string= 'ab \"AB\")", "t"},
      {"(string-equal \"ab\" \"AB\")", "t"},
      {"(string-downcase 'Ab)", "\"ab\""},
      {"(concatenate 'string \"a\" \"b\")", "\"ab\""},
      {"(let ((x 'left)) (format nil \"~a-~a ~s ~(~a~)~%\" x 2 :k 'ARM))", "\"LEFT-2 :K arm\n\""},
      {"(let ((x '(1 \"a\" b))) (format nil \"~a|~s\" x x))", "\"(1 a B)|(1 \\\"a\\\" B)\""},
      {"(mapcar #'evenp '(1 2))", "(nil t)"},
      {"(list (zerop 0) (plusp 1) (minusp 1) (oddp 3))", "(t t nil t)"},
      {"(prog1 1 2)", "1"},
      {"(prog2 1 2 3)", "2"},
      {"(destructuring-bind (a &optional (b 2) &key c) '(1) (list a b c))", "(1 2 nil)"},
      {"(destructuring-bind (a &rest r) '(1 2 3) (list a r))", "(1 (2 3))"},
      {"(destructuring-bind (a . r) '(1 2 3) (list a r))", "(1 (2 3))"},
      {"(destructuring-bind (&key a (b 5)) '(:a 1) (list a b))", "(1 5)"},
      {"(destructuring-bind ((a b) c) '((1 2) 3) (list a b c))", "(1 2 3)"},
      {"`(1 `(2 ,(3 ,(+ 1 3))))", "(1 (quasiquote (2 (unquote (3 4)))))"},
      {"(let ((x '(5 6))) `(1 `(2 ,(3 ,@x))))", "(1 (quasiquote (2 (unquote (3 5 6)))))"},
  });
}

TEST_CASE("Lisp: the clauses of loop") {
  check_values({
      {"(loop for x in '(1 2 3) sum x)", "6"},
      {"(loop for x in '(1 a 3) count (numberp x))", "2"},
      {"(loop for x in '(3 9 2) maximize x)", "9"},
      {"(loop for x in '(3 9 2) minimize x)", "2"},
      {"(loop for x in nil maximize x)", "nil"},
      {"(loop for x in '((1) (2 3)) append x)", "(1 2 3)"},
      {"(loop for x in '(1 2) collect x append (list x x))", "(1 1 1 2 2 2)"},
      {"(loop for (a b) in '((1 2) (3 4)) collect (+ a b))", "(3 7)"},
      {"(loop for (a . b) in '((1 . 2)) collect (list a b))", "((1 2))"},
      {"(loop for (a nil b) in '((1 2 3)) collect (list a b))", "((1 3))"},
      {"(loop for x on '(1 2 3) collect x)", "((1 2 3) (2 3) (3))"},
      {"(loop for (k v) on '(:a 1 :b 2) by #'cddr collect (list k v))", "((:a 1) (:b 2))"},
      {"(loop for x in '(1 2 3 4) by #'cddr collect x)", "(1 3)"},
      {"(loop with s = 0 for x in '(1 2) do (incf s x) finally (return s))", "3"},
      {"(loop for x = 1 then (* 2 x) while (< x 10) collect x)", "(1 2 4 8)"},
      {"(loop for x in '(1 2) for y = (* x x) collect y)", "(1 4)"},
      {"(loop for x in '(1 2 3 4) when (evenp x) collect x)", "(2 4)"},
      {"(loop for x in '(1 2 3 4) unless (evenp x) collect x else collect 'e)", "(1 e 3 e)"},
      {"(loop for x in '(1 2 3) if (oddp x) collect x and sum 0 into z else collect (- x) end)",
       "(1 -2 3)"},
      {"(loop for x in '(1 2 3) when (= x 2) return x)", "2"},
      {"(loop for x in '(1 2 3) thereis (and (> x 1) (* x 10)))", "20"},
      {"(loop for x in '(1 3) always (oddp x))", "t"},
      {"(loop for x in '(1 2) never (evenp x))", "nil"},
      {"(loop for x in '(1 2) collect x into l finally (return (list 'got l)))", "(got (1 2))"},
      {"(loop named outer for x in '(1 2) do (loop for y in '(3) do (return-from outer y)))", "3"},
      {"(loop for i from 1 to 3 finally (return i))", "4"},
      {"(loop with a = 1 and b = 2 repeat 1 collect (list a b))", "((1 2))"},
      {"(let ((n 0)) (loop initially (setf n 5) repeat 2 do (incf n)) n)", "7"},
      {"(loop for x in '(1 2) and y in '(a b) collect (list x y))", "((1 a) (2 b))"},
  });
}

}  // namespace
}  // namespace parallax::compiler
