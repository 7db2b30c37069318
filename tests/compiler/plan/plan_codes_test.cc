#include <doctest/doctest.h>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

struct Case {
  std::string plan;
  std::string code;
  std::string message;  // of the first diagnostic with that code
};

const Case kCases[] = {
    {"(perform", "CPL001", "cannot read this datum: this list does not end"},
    {"(let ((x . 1)) x)", "CPL003", "malformed `x`: a dotted list is data: quote it"},
    {"(list . (1 . 2))", "CPL003", "malformed `list`: a dotted list is data: quote it"},
    {"(length '(1 . 2))", "CPL008", "`length`: argument 1 is a dotted list, not a list"},
    {"(apply #'list '(1 . 2))", "CPL008", "`apply`: expected a list, not a dotted list"},
    {"(perform #.x)", "CPL002", "the reader macro `#.` is not in the subset"},
    {"(let x 1)", "CPL003", "malformed `let`: expected a list of bindings"},
    {"(if)", "CPL003", "malformed `if`: expected a test, a form and perhaps another form"},
    {"(1 2)", "CPL003", "malformed `(...)`: a form starts with a name"},
    {"(perform (a thing (type x)))", "CPL003",
     "malformed `a`: expected motion, action, object or location"},
    {"(perform (a motion (type a b)))", "CPL003", "malformed `type`: a property is (key value)"},
    {"(let ((abc 1)) (list abd))", "CPL004", "no variable `abd` here"},
    {"(do-retry n (retry))", "CPL004", "no variable `n` here"},
    {"(defparameter *a* *b*)(defparameter *b* 1)(list *a*)", "CPL004", "no variable `*b*` here"},
    {"(defun f () 1)(defun x:f () 2)", "CPL005", "`f` is defined twice"},
    {"(define-condition plan-failure (plan-failure) ())(list 1)", "CPL005",
     "`plan-failure` is defined twice"},
    {"", "CPL006", "no plan to run: the file has no forms"},
    {"(defvar *x* 1)", "CPL006", "no plan to run: only definitions of variables"},
    {"(defun f (x) x)", "CPL006", "no plan to run: `f` needs arguments"},
    {"(defun f (x) x)(f)", "CPL007", "`f`: no value for `x`"},
    {"(defun f (x) x)(f 1 2)", "CPL007", "`f`: unexpected argument `2`"},
    {"(defun f (&key x) x)(f :y 2)", "CPL007", "`f`: unexpected argument `:y`"},
    {"(defun f (x) x)(apply #'f '(1 2))", "CPL007", "`f`: unexpected argument 2"},
    {"(apply #'cons '(1))", "CPL007", "`cons`: it is called with 1 argument"},
    {"(car)", "CPL007", "`car`: takes at least 1 arguments, not 0"},
    {"(defun f (&key x &allow-other-keys) x)(f 1)", "CPL007", "`f`: unexpected argument `1`"},
    {"(+ 1 'a)", "CPL008", "`+`: argument 2 is a, not a number"},
    {"(/ 1 0)", "CPL008", "`/`: division by zero"},
    {"(dolist (x 5) x)", "CPL008", "`dolist`: expected a list, not 5"},
    {"(destructuring-bind (a b) '(1) a)", "CPL008",
     "`destructuring-bind`: the pattern has 2 parts, the list 1"},
    {"(par)", "W-ERROR",
     "`par` signals an error whenever it is reached: without branches it waits for nothing"},
    {"(try-all)", "CPL003", "malformed `try-all`: without branches it waits for nothing and fails"},
    {"(par-loop (x (list)) x)", "CPL008",
     "`par-loop-list`: the list is empty, and nothing runs; guard it with `when`"},
    {"(make-quaternion 0 0 0 0)", "CPL008", "`make-quaternion`: the quaternion has no direction"},
    {"(holds 'f)", "CPL008", "`holds`: expected a quoted fluent such as '(holding left box)"},
    {"(performe (a motion (type going)))", "CPL010", "no form or function `performe`"},
    {"(fl-funcall #'car 1)", "CPL011",
     "`fl-funcall` waits for others or reacts to them, which is not followed here"},
    {"(wait-for 1)", "CPL011",
     "`wait-for` waits for others or reacts to them, which is not followed here"},
    {"(pursue)", "W-ERROR",
     "`pursue` signals an error whenever it is reached: without branches it waits for nothing"},
    {"(with-failure-handling ((plan-failure () 1)) 2)", "W-ERROR",
     "`plan-failure` signals an error whenever it is reached: it is called with the failure and "
     "has no variable for it"},
    {"(pursue (list 1) (list 2))", "W-PAR", "the branches of `pursue` are taken in written order"},
    {"(with-failure-handling ((condition (e) (return))) 1)", "CPL013",
     "`condition` is not in the subset here: on the robot its handler also hears signals of the "
     "scheduler, at any time; name `plan-failure` or `error`"},
    // A failure of the rules is of both classes.
    {"(defmethod f ((e plan-failure)) 1)(defmethod f ((e error)) 2)(f 1)", "CPL013",
     "`error` is not in the subset here: which type of its methods comes first is not known"},
    {"(handler-case 1 (t () 2))", "CPL013",
     "`t` is not in the subset here: on the robot its handler also hears signals of the "
     "scheduler, at any time; name `plan-failure` or `error`"},
    {"(setf (symbol-value 'y) 1)", "CPL012",
     "`setf` writes to `(symbol-value (quote y))`, which is not a lexical variable"},
    {"(defconstant +x+ 1)(setf +x+ 2)", "CPL012",
     "`setf` writes to `+x+`, which is not a lexical variable"},
    {"(flet ((g () 1)) (funcall 'g))", "CPL010", "no form or function `g`"},
    {"((lambda (k) k))", "CPL007", "`a lambda`: no value for `k`"},
    {"((lambda))", "CPL003", "malformed `(...)`: expected a lambda with parameters"},
    {"(with-retry-counters ((m 1)) (with-retry-counters ((n 1)) (get-counter m)))", "CPL013",
     "`get-counter` is not in the subset here: `m` is a counter of an outer `with-retry-counters`, "
     "which the inner one does not know"},
    {"(with-retry-counters ((n 1)) (with-retry-counters ((n (reset-counter n))) (reset-counter "
     "n)))",
     "CPL003", "malformed `reset-counter`: the number of a counter cannot reset a counter"},
    {"(defun f () (:tag a (list 1)))(f)", "CPL003", "malformed `(...)`: a form starts with a name"},
    {"(list 1)(flet ((f () (defmacro m () 1))) (f))", "CPL013",
     "`defmacro` is not in the subset here: macros are defined at top level; use `macrolet`"},
    {"(loop for x being the symbols of y do (print x))", "CPL013",
     "`symbols` is not in the subset here: this kind of `for x`"},
    {"(loop for x across 5 do (print x))", "CPL008", "`loop`: argument 1 is 5, not an array"},
    {"(defmacro m () '(m))(m)", "CPL052",
     "expanding the plan's macros takes more than 50000 expansions"},
    {"(m)(defmacro m () 1)", "CPL053", "macro `m`: it is used above its definition"},
    {"(ros-info (x) (perform (a motion (type signalling))))", "CPL013",
     "`perform` is not in the subset here: the arguments of `ros-info` are not evaluated"},
    {"(defvar *x* (perform (a motion (type signalling))))(list *x*)", "CPL013",
     "`perform` is not in the subset here: the value of a global constant cannot perform"},
    {"(list #\\a)", "CPL013", "`#\\a` is not in the subset here: characters have no use in a plan"},
    {"(let ((o (perform (a motion (type detecting) (object (an object (type cup))))))) (< o 3))",
     "CPL020", "`<` compares a value of the model; numeric fluent comparison is not in the subset"},
    {"(let ((o (perform (a motion (type detecting) (object (an object (type cup))))))) (dolist (x "
     "o) x))",
     "CPL021", "`dolist` needs a list that is known while unrolling, not a value of the model"},
    {"(perform (a motion (type goin) (target nil)))", "CPL030",
     "no binding for motion `goin` with the keys (:target)"},
    {"(perform (a motion (type going)))", "CPL030",
     "no binding for motion `going` with the keys ()"},
    {"(prolog '(in-hand left box))", "CPL030", "no binding for query `in-hand` with 2 arguments"},
    {"(prolog '(and (in-hand box) (in-hand cup)))", "CPL030",
     "no binding for query `in-hand` with 1 arguments"},
    {"(prolog 'in-hand)", "CPL008",
     "`prolog`: expected a quoted fluent such as '(holding left box)"},
    {"(perform 5)", "CPL030", "no binding for 5: only motions and actions are performed"},
    {"(perform (an action (type picking-up) (arm left) (object (an object (type box)))))", "CPL033",
     "the performed designator gives `?o` a designator without a name; name it, detect it first, "
     "or say in an `object` entry of the binding table what it can mean"},
    {"(perform (a motion (type detecting) (object (an object (name box)))))", "CPL033",
     "the motion designator gives `object` no `type`"},
    {"(retry)", "CPL040", "`retry` outside a failure handler"},
    {"(progn (retry))", "CPL040", "`retry` outside a failure handler"},
    {"(fail 'perception-object-not-fond)", "CPL041",
     "no failure class `perception-object-not-fond`"},
    {"(with-failure-handling ((nonsense (e) 1)) 1)", "CPL041", "no failure class `nonsense`"},
    {"(return 1)", "CPL042", "`return` leaves no block around it"},
    {"(defun f () (f))(f)", "CPL050",
     "`f` calls itself more than 8 deep without performing anything"},
    {"(par (list 1) (list 2))", "W-PAR", "the branches of `par` are taken in written order"},
    {"(check-placing-collisions 1)", "W-PROJ",
     "`check-placing-collisions` looks ahead in a projection; it is taken to find nothing"},
    {"(check-any-new-collisions 1)", "W-PROJ",
     "`check-any-new-collisions` looks ahead in a projection; it is taken to find nothing"},
    {"(list (all objects (type cup)))", "W-ALL",
     "`(all ...)` stands for a list of objects that only the model knows"},
};

TEST_CASE("codes: a reactive form is refused where it stands, with the way to write it") {
  const std::pair<std::string, std::string> forms[] = {
      {"(partial-order ((sig) (go1)) (:order a b))", "in a `seq`"},
      {"(cpl:wait-for 1)", "--par=interleave"},
      {"(with-policy p (1) (sig))", "in a `progn`"},
      {"(fl-pulsed a)", "value"},
  };
  for (const auto& [form, way] : forms) {
    CAPTURE(form);
    const auto plan = unroll(prelude() + form);
    CHECK(plan.codes() == Strings{"CPL011"});
    const auto entry = plan.sink.sorted().front();
    REQUIRE(entry.range.has_value());
    CHECK(plan.files[entry.range->file].text().substr(entry.range->begin, form.size()) == form);
    REQUIRE(entry.notes.size() == 1);
    CHECK(entry.notes[0].text.find(way) != std::string::npos);
  }
}

TEST_CASE("codes: every mistake has its code and says what was found") {
  for (const auto& one : kCases) {
    CAPTURE(one.plan);
    const auto plan = unroll(one.plan);
    REQUIRE(plan.has(one.code));
    const bool warning = std::string_view(one.code).starts_with("W-");
    CHECK(plan.graph.has_value() == warning);
    for (const auto& entry : plan.sink.sorted()) {
      if (base::info(entry.code).id != one.code) continue;
      CHECK(entry.message == one.message);
      break;
    }
  }
}

const base::Diagnostic& only(const std::vector<base::Diagnostic>& all) {
  REQUIRE(all.size() == 1);
  return all[0];
}

TEST_CASE("codes: a pose outside all regions names the nearest one and its distance") {
  const auto plan = unroll("(defvar *p* " + pose_at(2.5) +
                           ")\n(perform (a motion (type going)\n"
                           " (target (a location (pose *p*)))))");
  const auto all = plan.sink.sorted();
  const auto& error = only(all);
  CHECK(base::info(error.code).id == "CPL031");
  CHECK(error.message == "the pose (2.5, 0, 0) lies outside all regions of `region`");
  REQUIRE(error.notes.size() == 1);
  CHECK(error.notes[0].text == "the nearest is `r2`, 0.5 m away");
  CHECK(plan.files[error.range->file].position(error.range->begin).line == 2);
}

TEST_CASE("codes: names that the model does not have get a suggestion") {
  UnrollOptions options;
  options.constants = {"box1", "left"};
  const auto plan =
      unroll("(perform (an action (type picking-up) (arm left) (object (an object (name bix1)))))",
             options);
  const auto all = plan.sink.sorted();
  const auto& error = only(all);
  CHECK(base::info(error.code).id == "CPL032");
  CHECK(error.message == "the model has no constant `bix1`");
  CHECK(error.fix == "name `box1`");
}

TEST_CASE("codes: unknown and reactive forms name the nearest form of the subset") {
  const auto note = [](const char* text) {
    const auto plan = unroll(text);
    const auto all = plan.sink.sorted();
    REQUIRE_FALSE(all.empty());
    REQUIRE_FALSE(all[0].notes.empty());
    return all[0].notes[0].text;
  };
  CHECK(note("(whn t 1)") == "the nearest form of the subset is `when`");
  CHECK(note("(with-failure-handlin () 1)") ==
        "the nearest form of the subset is `with-failure-handling`");
  CHECK(note("(with-task 1 2)") == "write the body alone, in a `progn`");
  CHECK(note("(perform (a motion (type goin)))") == "the nearest binding is motion `going`");
}

TEST_CASE("codes: all mistakes of a plan come out in one run, also on paths not taken") {
  const auto plan = unroll("(when nil (foo) (setf (slot-value x) 1))\n(retry)\n(return)");
  CHECK(plan.codes() == Strings{"CPL010", "CPL012", "CPL040", "CPL042"});
}

TEST_CASE("codes: the outcome of one path does not hide the mistake on another") {
  const auto plan = unroll(prelude() + R"(
(with-failure-handling ((plan-failure (e) (+ 1 :a) (return))) (sig))
(perform (a motion (type going) (target 1/2)))
)");
  CHECK(plan.codes() == Strings{"CPL008", "CPL033"});
}

TEST_CASE("codes: limits of unrolling are reported") {
  UnrollOptions options;
  options.limits.max_locations = 5;
  CHECK(unroll(prelude() + "(dotimes (i 10) (sig))", options).codes() == Strings{"CPL051"});
  // The form that most of them begin at is named.
  const auto nested = unroll(prelude() + "(go1)(dotimes (i 10) (sig))", options);
  REQUIRE(nested.codes() == Strings{"CPL051"});
  REQUIRE(!nested.sink.sorted()[0].notes.empty());
  CHECK(nested.sink.sorted()[0].notes[0].text.find("most of its states, 5, begin at this "
                                                   "`perform`") == 0);
  // Up to a horizon fewer are needed, and the shortest ways to them come first.
  options.horizon = 4;
  const auto part =
      unroll(prelude() +
                 "(with-failure-handling ((plan-failure (e) (return))) (go1) (go1) (go1))"
                 "(dotimes (i 10) (sig))",
             options);
  CHECK(part.codes() == Strings{"CPL051"});
  options.limits.max_locations = 12;
  const auto whole =
      unroll(prelude() +
                 "(with-failure-handling ((plan-failure (e) (return))) (go1) (go1) (go1))"
                 "(dotimes (i 10) (sig))",
             options);
  REQUIRE(whole.codes().empty());
  CHECK(whole.terminals() == Strings{"BOUND(horizon)", "FAILED(simple-plan-failure)"});
  CHECK(whole.events("++++").size() == 5);
  options = {};
  options.limits.max_steps = 1000;
  CHECK(unroll("(dotimes (i 1000000) i)", options).codes() == Strings{"CPL051"});
}

TEST_CASE("codes: the failure class of a binding is checked against the plan's classes") {
  const auto binding = "motion a -> A() ok: F() @t else lost";
  const auto unknown = unroll("(perform (a motion (type a)))", {}, binding);
  CHECK(unknown.codes() == Strings{"CPL041"});
  CHECK(unknown.files.text(*unknown.sink.sorted()[0].range) == "lost");
  const auto known =
      unroll("(define-condition lost (plan-failure) ())(perform (a motion (type a)))", {}, binding);
  CHECK(known.terminals() == Strings{"DONE", "FAILED(lost)"});
}

}  // namespace
}  // namespace parallax::compiler
