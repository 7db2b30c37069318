// Things that can be changed: fluents, tables, arrays, structures, globals.
#include <doctest/doctest.h>

#include <set>
#include <string>

#include "tests/compiler/plan/plan_fixture.h"
#include "tests/compiler/plan/value_checks.h"
#include "tests/compiler/plan/ways.h"

namespace parallax::compiler {
namespace {

TEST_CASE("cells: hash tables") {
  check_values(
      {
          {"(let ((h (make-hash-table))) (setf (gethash :a h) 1) (gethash :a h))", "1"},
          {"(let ((h (make-hash-table))) (list (gethash :a h) (gethash :a h 7)))", "(nil 7)"},
          {"(let ((h (make-hash-table))) (setf (gethash :a h) nil) "
           "(multiple-value-list (gethash :a h)))",
           "(nil t)"},
          {"(let ((h (make-hash-table :test 'equal))) (setf (gethash (list 1 2) h) 5) "
           "(gethash (list 1 2) h))",
           "5"},
          {"(let ((h (make-hash-table))) (incf (gethash :n h 0)) (incf (gethash :n h 0) 4) "
           "(push 1 (gethash :l h)) (list (gethash :n h) (gethash :l h) (hash-table-count h)))",
           "(5 (1) 2)"},
          // Whoever has the table sees the change; two tables are two.
          {"(let* ((h (make-hash-table)) (l (list h))) (setf (gethash 1 (car l)) 2) (gethash 1 h))",
           "2"},
          {"(let ((g (make-hash-table)) (h (make-hash-table))) (setf (gethash 1 g) 2) "
           "(list (gethash 1 h) (eq g h) (eq g g)))",
           "(nil nil t)"},
          {"(let ((h (make-hash-table)) (n 0)) (setf (gethash 1 h) 2 (gethash 3 h) 4) "
           "(maphash (lambda (k v) (incf n (* k v))) h) n)",
           "14"},
          {"(let ((h (make-hash-table))) (setf (gethash 1 h) 2 (gethash 3 h) 4) (remhash 1 h) "
           "(loop for k being the hash-keys of h using (hash-value v) collect (list k v)))",
           "((3 4))"},
          {"(let ((h (make-hash-table))) (setf (gethash 1 h) 2 (gethash 3 h) 4) "
           "(list (loop for k being each hash-key in h sum k) "
           "(loop for v being the hash-values of h collect v)))",
           "(4 (2 4))"},
          {"(fill-table)", "(1 2)"},
      },
      "(defun note-it (h) (setf (gethash :a h) 1 (gethash :b h) 2))"
      "(defun fill-table () (let ((h (make-hash-table))) (note-it h) "
      "(hash-table-values h)))");
}

TEST_CASE("cells: what nothing refers to any more keeps no states apart") {
  const auto plan = with_prelude(
      "(dotimes (i 3) (let ((h (make-hash-table))) (setf (gethash i h) i)) (go1))"
      "(loop (let ((f (make-fluent :value 1))) (incf (value f))) (sig))");
  // The loop comes back to its state.
  CHECK(plan.graph->locations.size() == 4);
  // A table in a table lives as long as that.
  check_values(
      {{"(let ((outer (make-hash-table))) "
        "(let ((inner (make-hash-table))) (setf (gethash 1 inner) 2 (gethash :in outer) inner))"
        " (make-hash-table) (gethash 1 (gethash :in outer)))",
        "2"}});
}

TEST_CASE("cells: arrays") {
  check_values({
      {"(let ((a (make-array 3 :initial-element 0))) (setf (aref a 1) 5) (coerce a 'list))",
       "(0 5 0)"},
      {"(let ((a (vector 1 2 3))) (list (length a) (aref a 2) (svref a 0)))", "(3 3 1)"},
      {"(let ((a (make-array '(2 3) :initial-element 0))) (setf (aref a 1 2) 7) "
       "(list (aref a 1 2) (aref a 0 2) (array-dimensions a)))",
       "(7 0 (2 3))"},
      {"(loop for x across (vector 1 2 3) collect (* x x))", "(1 4 9)"},
      {"(let ((a (make-array 2 :initial-contents '(1 2))) (n 0)) (incf (aref a (incf n)) 10) "
       "(list n (aref a 1)))",
       "(1 12)"},
      {"(let ((a (vector 1 2))) (rotatef (aref a 0) (aref a 1)) (coerce a 'list))", "(2 1)"},
      {"(handler-case (aref (vector 1) 5) (error () 'e))", "e"},
  });
}

TEST_CASE("cells: structures and classes") {
  check_values(
      {
          {"(let ((p (make-place :x 1))) (setf (place-x p) 7) (list (place-x p) (place-y p)))",
           "(7 2)"},
          {"(let ((p (make-place :x 1))) (incf (place-y p)) (place-y p))", "3"},
          {"(list (place-p (make-place)) (place-p 1) (typep (make-place) 'place) (typep 1 'place))",
           "(t nil t nil)"},
          {"(let* ((p (make-place :x 1)) (q (copy-place p))) (setf (place-x q) 9) "
           "(list (place-x p) (place-x q)))",
           "(1 9)"},
          {"(let ((s (make-shelf :level 3))) (list (shelf-level s) (shelf-y s) (place-p s)))",
           "(3 2 t)"},
          {"(mapcar #'place-x (list (make-place :x 1) (make-place :x 2)))", "(1 2)"},
          {"(let ((k (make-instance 'kit :size 3))) (setf (kit-size k) 4) "
           "(list (kit-size k) (slot-value k 'tools) (kit-tools k)))",
           "(4 (a) (a))"},
          {"(kit-size (make-instance 'big-kit))", "10"},
          {"(typecase (make-instance 'big-kit) (place 1) (kit 2))", "2"},
          {"(handler-case (place-x 5) (type-error () 'e))", "e"},
      },
      "(defstruct place \"somewhere\" x (y 2))"
      "(defstruct (shelf (:include place)) level)"
      "(defclass kit () ((size :initarg :size :accessor kit-size :initform 1) "
      "(tools :initform '(a) :reader kit-tools)))"
      "(defclass big-kit (kit) ((size :initarg :size :initform 10)))");
  // A structure that nothing names does not count.
  CHECK(with_prelude("(defstruct (odd (:constructor make (a b))) (x (read-it)))(go1)").codes() ==
        Strings{});
  CHECK(unroll(prelude() + "(make-instance 'nothing)").has("CPL010"));
}

TEST_CASE("cells: methods are chosen by types") {
  check_values(
      {
          {"(list (kind (make-place)) (kind (make-shelf)) (kind 3) (kind 2.5) (kind :stop) (kind "
           "\"a\"))",
           "(place shelf integer number stop other)"},
          {"(list (both 1 (make-shelf)) (both :a (make-place)) (both 1 2))",
           "(n-shelf any-place none)"},
          {"(list (scaled 3) (scaled 3 :by 4) (scaled 'a))", "(6 12 (a 2))"},
          {"(handler-case (only-texts 1) (error () 'e))", "e"},
          {"(mapcar #'kind (list (make-shelf) 1))", "(shelf integer)"},
      },
      "(defstruct place x)(defstruct (shelf (:include place)) level)"
      "(defgeneric kind (thing) (:documentation \"what it is\"))"
      "(defmethod kind (thing) 'other)(defmethod kind ((n number)) 'number)"
      "(defmethod kind ((p place)) 'place)(defmethod kind ((n integer)) 'integer)"
      "(defmethod kind ((s shelf)) 'shelf)(defmethod kind ((word (eql :stop))) 'stop)"
      "(defmethod both (a b) 'none)(defmethod both (a (p place)) 'any-place)"
      "(defmethod both ((n number) (s shelf)) 'n-shelf)"
      "(defmethod scaled ((n number) &key (by 2)) (* n by))"
      "(defmethod scaled (thing &key (by 2)) (list thing by))"
      "(defmethod only-texts ((text string)) text)");
  CHECK(unroll(prelude() + "(defmethod f :around (x) x)(f 1)").has("CPL013"));
  CHECK(unroll(prelude() + "(defmethod f (x) (call-next-method))(f 1)").has("CPL013"));
}

TEST_CASE("cells: globals that are set") {
  const std::string globals =
      "(defparameter *n* 0)(defun count-it () (incf *n*))(def-cram-function task () (count-it))";
  check_values(
      {
          {"(progn (setf *n* 3) (count-it) *n*)", "4"},
          {"(progn (count-it) (let ((*n* 10)) (count-it)) (count-it) *n*)", "2"},
          {"(progn (task) (task) *n*)", "2"},  // all tasks see it
          {"(progn (push 1 *l*) (push 2 *l*) *l*)", "(2 1)"},
          {"(let ((f (let ((*n* 2)) (lambda () (setf *n* 3))))) (funcall f) *n*)", "3"},
      },
      globals + "(defvar *l* nil)");
  check_refused({{"(defconstant +x+ 1)(setf +x+ 2)", "CPL012", "1:26",
                  "`setf` writes to `+x+`, which is not a lexical variable"}});
  // Paths whose globals differ stay apart.
  const auto plan = with_prelude(
      "(defvar *tried* nil)"
      "(with-failure-handling ((plan-failure (e) (unless *tried* (setf *tried* t) (retry)) "
      "(return))) (go1))(if *tried* (sig) (go2))");
  CHECK(plan.events("++") == Strings{"Go(r1)", "Go(r2)", "DONE"});
  CHECK(plan.events("-++") == Strings{"Go(r1)", "Go(r1)", "Signal()", "DONE"});
}

TEST_CASE("cells: fluents and networks of them") {
  check_values({
      {"(let ((f (make-fluent :name 'a :value 1))) (setf (value f) 2) (value f))", "2"},
      {"(let* ((f (make-fluent :value 1)) (g (make-fluent :value nil)) (n (fl-and f (fl-not g)))) "
       "(list (value n) (progn (setf (value g) 5) (value n))))",
       "(t nil)"},
      {"(let* ((f (make-fluent :value 1)) (n (fl< f 3)) (a (value n))) (setf (value f) 4) "
       "(list a (value n)))",
       "(t nil)"},
      {"(let* ((f (make-fluent :value 1)) (n (< (+ f 1) 3)) (a (value n))) (incf (value f)) "
       "(list a (value n)))",
       "(t nil)"},
      {"(let ((f (make-fluent))) (list (value f) (value (fl-or f 7)) (typep f 'fluent)))",
       "(nil 7 t)"},
  });
  CHECK(unroll(prelude() + "(let ((f (make-fluent))) (par (wait-for f) (go1)))").has("CPL011"));
}

TEST_CASE("cells: networks that share their parts are computed once, and not too deep") {
  const std::string doubled = "(let* ((f (make-fluent :value 1)) (n (fl+ f f))) (dotimes (i ";
  const auto plan = with_prelude(doubled + "40) (setf n (fl+ n n))) (when (> (value n) 1) (sig)))");
  CHECK(plan.events("+") == Strings{"Signal()", "DONE"});
  CHECK(unroll(prelude() + doubled + "2000) (setf n (fl+ n 1))) (value n))").has("CPL008"));
}

TEST_CASE("cells: branches wait for fluents") {
  const auto ways = [](const std::string& text, const std::set<std::string>& fail = {}) {
    const auto plan = by_turns(text);
    CAPTURE(text);
    REQUIRE(plan.codes() == Strings{});
    std::set<std::string> out;
    for (const auto& way : Ways(plan, fail).all) {
      const auto place = way.find(" at plan.lisp");
      out.insert(place == std::string::npos ? way : way.substr(0, place) + ")");
    }
    return out;
  };
  using All = std::set<std::string>;
  CHECK(ways("(let ((f (make-fluent))) (par (progn (go1) (setf (value f) t)) "
             "(progn (wait-for f) (sig))))") == All{"Go(r1) Signal() DONE"});
  // Nobody sets it: the branch waits for ever, and so does a plan without branches.
  CHECK(ways("(let ((f (make-fluent))) (par (go1) (progn (wait-for f) (sig))))") ==
        All{"Go(r1) BOUND(wait-for)"});
  CHECK(ways("(let ((f (make-fluent))) (go1) (wait-for f) (sig))") ==
        All{"Go(r1) BOUND(wait-for)"});
  CHECK(ways("(let ((f (make-fluent :value 1))) (wait-for f) (sig))") == All{"Signal() DONE"});
  CHECK(ways("(let ((f (make-fluent))) (wait-for f :timeout 1) (sig))") == All{"Signal() DONE"});
  // A time limit may be over before or after the perform.
  CHECK(ways("(let ((f (make-fluent))) (par (progn (go1) (setf (value f) t)) "
             "(if (wait-for f :timeout 1) (sig) (pick))))") == All{"Go(r1) Signal() DONE",
                                                                   "PickUp(left,box) Go(r1) DONE",
                                                                   "Go(r1) PickUp(left,box) DONE"});
  // Values that another branch takes back before it waits are not seen.
  const auto gaps = by_turns("(let ((f (make-fluent))) (par (setf (value f) t) (wait-for f)))");
  REQUIRE(gaps.graph.has_value());
  REQUIRE(gaps.graph->gaps.size() == 1);
  CHECK(gaps.graph->gaps[0].text == "values of fluents that last for no turn");
  // The monitor ends with what it watches.
  CHECK(ways("(let ((f (make-fluent))) (pursue (whenever (f) (sig) (setf (value f) nil)) "
             "(progn (setf (value f) t) (go1) (go2))))")
            .contains("Go(r1) Signal() Go(r2) DONE"));
  CHECK(ways("(let ((n (make-fluent :value 0))) (pursue (progn (wait-for (fl> n 1)) (pick)) "
             "(loop (go1) (incf (value n)))))")
            .contains("Go(r1) Go(r1) PickUp(left,box) DONE"));
}

TEST_CASE("branches: a try-all fails when all have failed, and ends with the first that has not") {
  const auto plan = by_turns("(try-all (go1) (pick))(sig)");
  REQUIRE(plan.graph.has_value());
  using All = std::set<std::string>;
  CHECK(Ways(plan, {"Go(r1)", "PickUp(left,box)"}).all ==
        All{"Go(r1) PickUp(left,box) FAILED(composite-failure)",
            "PickUp(left,box) Go(r1) FAILED(composite-failure)"});
  CHECK(Ways(plan, {"Go(r1)"}).all.contains("Go(r1) PickUp(left,box) Signal() DONE"));
  CHECK(Ways(plan).all.contains("PickUp(left,box) Signal() DONE"));
  const auto in_order = unroll(prelude() + "(try-all (go1) (pick))(sig)");
  CHECK(in_order.codes() == Strings{"W-PAR"});
  CHECK(in_order.events("-++") == Strings{"Go(r1)", "PickUp(left,box)", "Signal()", "DONE"});
}

/// The gaps of a plan whose branches take turns.
Strings gaps_of(const std::string& text) {
  const auto plan = by_turns(text);
  CAPTURE(text);
  REQUIRE(plan.graph.has_value());
  Strings out;
  for (const auto& gap : plan.graph->gaps) out.push_back(gap.text);
  return out;
}

TEST_CASE("cells: functions that rules call may change and make things") {
  check_values(
      {
          {"(progn (prolog '(lisp-fun set-it ?x)) *g*)", "2"},
          {"(progn (prolog '(and (lisp-fun set-it ?x) (equal ?x 9))) *g*)", "2"},
          {"(progn (prolog '(lisp-fun set-and-fail ?x)) *g*)", "3"},
          {"(let ((v (var-value '?x (lazy-car (prolog '(lisp-fun vector x :b ?x)))))) (aref v 1))",
           ":b"},
          {"(let ((h (var-value '?x (lazy-car (prolog '(lisp-fun make-it ?x)))))) "
           "(eq h (make-hash-table)))",
           "nil"},
          {"(progn (prolog '(lisp-fun ask-within ?x)) *g*)", "(2 4)"},
      },
      "(defvar *g* 1)(defun set-it () (setf *g* 2) 2)"
      "(defun set-and-fail () (setf *g* 3) (error \"no\"))(defun make-it () (make-hash-table))"
      "(defun ask-within () (prolog '(lisp-fun set-it ?x)) (setf *g* (list *g* 4)) 1)");
}

TEST_CASE("cells: branches that change what others use have orders that are not explored") {
  const Strings told = {"when branches change what others use"};
  CHECK(gaps_of("(let ((v 1)) (par (setf v 2) (when (= v 2) (go1))))") == told);
  CHECK(gaps_of("(defvar *g* 1)(par (setf *g* 3) (setf *g* 2))(when (= *g* 2) (go1))") == told);
  const std::string two = "(let ((a (an object (type cup))) (b (an object (type box)))) ";
  CHECK(gaps_of(two + "(par (equate a b) (current-desig a)))") == told);
  CHECK(gaps_of(two + "(par (seq (go1) (equate a b)) (go2)))") == told);
  CHECK(gaps_of(two + "(equate a b) (par (current-desig a) (desig-equal a b)))") == Strings{});
  CHECK(gaps_of("(defvar *g* 1)(defun f () (setf *g* 3))(par (f) (when (= *g* 2) (go1)))") == told);
  CHECK(gaps_of("(let ((h (make-hash-table))) (par (setf (gethash 1 h) 2) "
                "(when (gethash 1 h) (go1))))") == told);
  CHECK(gaps_of("(let ((v 1)) (par (setf v 2) (funcall (lambda () (when (= v 2) (go1))))))") ==
        told);
  // Each has its own, or only one of them uses it.
  CHECK(gaps_of("(let ((v 1) (w 1)) (par (progn (go1) (setf v 2)) (progn (go2) (setf w 2))) v)") ==
        Strings{});
  CHECK(gaps_of("(defun f (x) (setf x (+ x 1)) (go1))(par (f 1) (f 2))") == Strings{});
}

TEST_CASE("cells: what changes the making of things is refused, or read") {
  const std::string kit = "(defclass kit () ((size :initarg :size :accessor kit-size)))";
  const auto has = [&](const std::string& text, std::string_view code) {
    return unroll(prelude() + kit + text).has(code);
  };
  CHECK(
      has("(defmethod initialize-instance :after ((k kit) &key) (setf (kit-size k) 5))"
          "(kit-size (make-instance 'kit :size 1))",
          "CPL013"));
  CHECK(has("(defclass odd (kit) () (:default-initargs :size 3))(make-instance 'odd)", "CPL013"));
  CHECK(has("(defclass b () ())(defclass odd (kit b) ())(make-instance 'odd)", "CPL013"));
  CHECK(has("(defclass odd () ((n :allocation :class)))(make-instance 'odd)", "CPL013"));
  CHECK(has("(defclass odd () ((n :initarg :n :initarg :m)))(make-instance 'odd)", "CPL013"));
  CHECK(has("(defmethod kit-size ((n number)) n)(kit-size 3)", "CPL013"));
  CHECK(has("(kit-size (make-instance 'kit))", "CPL008"));  // nothing was put there
  check_values(
      {
          {"(kit-size (make-instance 'big))", "7"},
          {"(kit-size (make-instance 'big :size 1))", "1"},
          {"(handler-case (kit-size (make-instance 'other :size 1)) (type-error () 'e))", "e"},
          {"(handler-case (setf (kit-size (make-instance 'other :size 1)) 2) (error () 'e))", "e"},
          {"(sized 3)", "4"},
          {"(twice 3)", "second"},
      },
      kit +
          "(defclass big (kit) ((size :initform 7)))"
          "(defclass other () ((size :initarg :size)))"
          "(defgeneric sized (x) (:method ((n number)) (+ n 1)))"
          "(defmethod twice ((n number)) 'first)(defmethod twice ((n number)) 'second)");
  CHECK(has("(defmethod f ((e plan-failure)) 1)(defmethod f ((e error)) 2)(f 1)", "CPL013"));
  CHECK(has("(defmethod f ((n integer) &key a) a)(defmethod f ((n number) &key b) b)(f 1)",
            "CPL013"));
}

TEST_CASE("cells: sameness, digits and what nothing was put into") {
  check_values({
      {"(let ((f (make-fluent :value 1))) (case f (1 'no) (t 'yes)))", "yes"},
      {"(let ((f (make-fluent))) (if (member f (list 1 2)) 'in 'out))", "out"},
      {"(parse-integer \" 5 \")", "5"},
      {"(handler-case (parse-integer \"4/2\") (error () 'e))", "e"},
      {"(handler-case (parse-integer \"5.\") (error () 'e))", "e"},
      {"(expt 2.0 0)", "1.0"},
      {"(length (make-array 2))", "2"},
  });
  const auto codes = [&](const std::string& text) { return unroll(prelude() + text).codes(); };
  CHECK(codes("(aref (make-array 2) 0)") == Strings{"CPL008"});
  CHECK(codes("(make-hash-table :test 'equalp)") == Strings{"CPL008"});
  CHECK(codes("(gethash \"a\" (make-hash-table))") == Strings{"CPL008"});
  CHECK(!codes("(iterate (for x in '(1 2)) (finding x maximizing x))").empty());
}

TEST_CASE("cells: changes that others would see in Lisp are told") {
  CHECK(gaps_of("(let ((l (list 1 2))) (delete 1 l))") ==
        Strings{"what `delete` leaves of its list"});
  CHECK(gaps_of("(let ((l (list 2 1))) (sort (copy-list l) #'<))") == Strings{});
  CHECK(gaps_of("(let ((l (list 2 1))) (sort l #'<))") ==
        Strings{"what `sort` leaves of its list"});
  const Strings alike = {"equal things taken for one thing"};
  CHECK(gaps_of("(case \"a\" (\"a\" 1))") == alike);
  CHECK(gaps_of("(member \"a\" '(\"a\"))") == alike);
  CHECK(gaps_of("(member \"a\" '(\"b\"))") == Strings{});
  CHECK(gaps_of("(member \"a\" '(\"a\") :test #'equal)") == Strings{});
  CHECK(gaps_of("(let ((a \"x\") (b \"x\")) (eql a b))") == alike);
  CHECK(gaps_of("(let ((a (list 1)) (b (list 1))) (eq a b) (equal a b))") == alike);
  CHECK(gaps_of("(equal (make-identity-pose) (make-identity-pose))") == alike);
  CHECK(gaps_of("(equal (list (make-identity-pose)) (list (make-identity-pose)))") == alike);
  CHECK(gaps_of("(eq (an object (type cup)) (an object (type cup)))") == alike);
  CHECK(gaps_of("(position \"a\" (list \"b\" \"a\"))") == alike);
  CHECK(gaps_of("(count 'a '(a b a))") == Strings{});
  CHECK(gaps_of("(eql nil '())") == Strings{});
  CHECK(gaps_of("(let ((a (vector 1 2))) (loop for x across a do (setf (aref a 1) 5)))") ==
        Strings{"changes of an array behind a loop across it"});
}

}  // namespace
}  // namespace parallax::compiler
