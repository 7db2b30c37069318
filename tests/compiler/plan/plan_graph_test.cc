#include "compiler/plan/plan_graph.h"

#include <doctest/doctest.h>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

TEST_CASE("graph: the text dump shows every location with its edges") {
  const auto plan = unroll("(defvar *p* " + pose_at(0.5) +
                           ")\n(perform (a motion (type going) (pose *p*)))\n"
                           "(when (holds '(|Dark|)) (perform (a motion (type signalling))))");
  REQUIRE(plan.graph.has_value());
  CHECK(dump_text(*plan.graph, plan.files) ==
        "entry L0\n"
        "L0 Go(r1) at plan.lisp:2\n"
        "  ok: RobotAt(r1) @t+1\n"
        "  target.x = 0.5\n"
        "  target.y = 0\n"
        "  target.yaw = 0\n"
        "  target.z = 0\n"
        "  success -> B0\n"
        "  navigation-pose-unreachable -> FAILED(navigation-pose-unreachable)\n"
        "L1 Signal() at plan.lisp:3\n"
        "  ok: Signalled() @t+1\n"
        "  success -> DONE\n"
        "  simple-plan-failure -> FAILED(simple-plan-failure)\n"
        "B0 Dark() at plan.lisp:3\n"
        "  true -> L1\n"
        "  false -> DONE\n");
  CHECK(longest_path(*plan.graph) == 2);
}

TEST_CASE("graph: the picture names every node and edge") {
  const auto plan = unroll("(perform (a motion (type signalling)))");
  REQUIRE(plan.graph.has_value());
  CHECK(dump_dot(*plan.graph, plan.files) ==
        "digraph plan {\n"
        "  node [shape=box];\n"
        "  start [shape=point];\n"
        "  L0 [label=\"Signal() at plan.lisp:1\"];\n"
        "  T0 [shape=oval, label=\"DONE\"];\n"
        "  T1 [shape=oval, label=\"FAILED(simple-plan-failure)\"];\n"
        "  start -> L0;\n"
        "  L0 -> T0;\n"
        "  L0 -> T1 [style=dashed, label=\"simple-plan-failure\"];\n"
        "}\n");
}

TEST_CASE("graph: a plan without performs goes straight to a terminal") {
  const auto plan = unroll("(list 1)");
  REQUIRE(plan.graph.has_value());
  CHECK(plan.walk("") == "DONE");
  CHECK(longest_path(*plan.graph) == 0);
}

TEST_CASE("graph: unrolling twice gives the same dump") {
  const std::string text = prelude() +
                           "(dotimes (i 3) (with-failure-handling ((plan-failure (e) (go2) "
                           "(return))) (go1) (pick)))";
  const auto one = unroll(text);
  const auto two = unroll(text);
  REQUIRE(one.graph.has_value());
  CHECK(dump_text(*one.graph, one.files) == dump_text(*two.graph, two.files));
}

}  // namespace
}  // namespace parallax::compiler
