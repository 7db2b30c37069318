#include <doctest/doctest.h>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

std::string repeat(std::string_view part, std::size_t count) {
  std::string out;
  out.reserve(part.size() * count);
  for (std::size_t i = 0; i < count; ++i) out += part;
  return out;
}

TEST_CASE("hostile: 100,000 nested parentheses end in one clear error") {
  for (const auto* open : {"(", "'(", "`", "#+seecer (", "(progn "}) {
    const auto plan = unroll(repeat(open, 100000));
    CHECK(plan.codes() == Strings{"CPL001"});
  }
  const auto closed = unroll(repeat("(", 100000) + repeat(")", 100000));
  CHECK(closed.codes() == Strings{"CPL001"});
}

TEST_CASE("hostile: nesting up to the limit is compiled and run") {
  const auto plan = unroll(prelude() + repeat("(progn ", 990) + "(sig)" + repeat(")", 990));
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("+") == Strings{"Signal()", "DONE"});
  const auto handlers =
      unroll(prelude() + repeat("(with-failure-handling ((plan-failure (e) (sig))) ", 400) +
             "(sig)" + repeat(")", 400));
  REQUIRE(handlers.graph.has_value());
  CHECK(handlers.graph->locations.size() == 401);
}

TEST_CASE("hostile: a 10 MB line is read or refused") {
  const auto symbol = unroll("(list '" + std::string(10000000, 'a') + ")");
  CHECK(symbol.graph.has_value());
  const auto text = unroll("(list \"" + std::string(10000000, 'a') + "\")");
  CHECK(text.graph.has_value());
  const auto number = unroll("(list " + std::string(10000000, '9') + ")");
  CHECK(number.codes() == Strings{"CPL001"});
  const auto many = unroll("(list '(" + repeat("a ", 5000000) + "))");
  CHECK(many.codes() == Strings{"CPL001"});
  const auto unknown = unroll("(" + std::string(10000000, 'b') + ")");
  CHECK(unknown.codes() == Strings{"CPL010"});
}

TEST_CASE("hostile: recursion without end is an error or a bound") {
  CHECK(unroll("(defun f () (g))(defun g () (f) (f))(f)").codes() == Strings{"CPL050"});
  const auto tree = unroll(prelude() + "(defun f () (sig) (f) (f))(f)");
  REQUIRE(tree.graph.has_value());
  CHECK(tree.graph->locations.size() == 8);
  CHECK(unroll("(labels ((f (n) (f (+ n 1)))) (f 0))").codes() == Strings{"CPL050"});
}

TEST_CASE("hostile: deep calls in many states stop at a limit of memory") {
  UnrollOptions options;
  options.limits.max_call_depth = 1000;
  const auto plan =
      unroll(prelude() +
                 "(defun f (n) (sig) (with-failure-handling ((plan-failure (e) (f (+ n "
                 "2)))) (f (+ n 1))))(f 0)",
             options);
  CHECK(plan.codes() == Strings{"CPL051"});
}

TEST_CASE("hostile: a plan with too many states stops at the limit") {
  // Every outcome is remembered, so no two paths meet: 2^30 states.
  const auto plan = unroll(prelude() + R"(
(let ((seen nil))
  (dotimes (i 30)
    (with-failure-handling ((plan-failure (e) (push i seen) (return))) (sig))))
)");
  CHECK(plan.codes() == Strings{"CPL051"});
}

TEST_CASE("hostile: loops that build or read ever longer lists stop at a limit") {
  for (const auto* text :
       {"(dotimes (i 100000000) (list i i i))",
        "(let ((l '(1))) (dotimes (i 60) (setf l (append l l))))",
        "(let ((l nil)) (dotimes (i 1000000) (push i l) (length l)))",
        "(let ((s \"ab\")) (dotimes (i 60) (setf s (concatenate 'string s s s))))"}) {
    CHECK(unroll(text).codes() == Strings{"CPL051"});
  }
}

TEST_CASE("hostile: no prefix of a real plan crashes the reader or the compiler") {
  const std::string text = prelude() + R"(
(with-retry-counters ((tries 2))
  (with-failure-handling (((or plan-failure low-level-failure) (e) (do-retry tries (retry))))
    (unwind-protect (let* ((a 1)) (loop for i from a to 2 do (pick)) #'car) `(1 ,(go1)))))
)";
  for (std::size_t length = 0; length <= text.size(); length += 2) {
    const auto plan = unroll(text.substr(0, length));
    CHECK(plan.graph.has_value() != plan.sink.has_errors());
  }
}

TEST_CASE("hostile: forms with too few parts are malformed, never a crash") {
  for (const auto* head : {"let",
                           "let*",
                           "setf",
                           "incf",
                           "push",
                           "destructuring-bind",
                           "progn",
                           "seq",
                           "par",
                           "if",
                           "when",
                           "unless",
                           "cond",
                           "case",
                           "ecase",
                           "and",
                           "or",
                           "block",
                           "return",
                           "return-from",
                           "holds",
                           "dolist",
                           "dotimes",
                           "loop",
                           "mapcar",
                           "every",
                           "try-in-order",
                           "try-each-in-order",
                           "with-failure-handling",
                           "handle-failure",
                           "with-retry-counters",
                           "do-retry",
                           "get-counter",
                           "retry",
                           "fail",
                           "unwind-protect",
                           "a",
                           "an",
                           "all",
                           "perform",
                           "funcall",
                           "flet",
                           "labels",
                           "quote",
                           "quasiquote",
                           "function",
                           "lambda",
                           "defun",
                           "defparameter",
                           "define-condition",
                           "unquote",
                           "with-process-modules-running"}) {
    for (const auto* tail : {"", " nil", " x", " (x)", " ((x))", " ((x y))", " (x y) z", " 5 6 7",
                             " \"s\" :k", " () ()", " ((x (y))) z", " (()) (())"}) {
      const auto text = std::string("(") + head + tail + ")";
      CAPTURE(text);
      const auto plan = unroll(text);
      CHECK(plan.graph.has_value() != plan.sink.has_errors());
      const auto inside = unroll("(dolist (q '(1)) (list " + text + "))");
      CHECK(inside.graph.has_value() != inside.sink.has_errors());
    }
  }
}

}  // namespace
}  // namespace parallax::compiler
