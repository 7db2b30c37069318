#include "compiler/plan/plan_binding.h"

#include <doctest/doctest.h>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

struct Bound {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  std::optional<PlanBinding> binding;
};

Bound read_table(std::string_view text) {
  Bound out;
  const auto file = out.files.add("plan.bind", std::string(text));
  if (auto result = parse_plan_binding(out.files, file, out.sink)) out.binding = std::move(*result);
  return out;
}

std::string errors(const Bound& bound) {
  std::string out;
  for (const auto& one : bound.sink.sorted()) {
    const auto at = bound.files[one.range->file].position(one.range->begin);
    out += fmt::format("{} {}:{} {}\n", base::info(one.code).id, at.line, at.column, one.message);
  }
  return out;
}

TEST_CASE("binding: the table of the documentation") {
  const auto bound = read_table(kBinding);
  CHECK(errors(bound).empty());
  REQUIRE(bound.binding.has_value());
  const auto& entries = bound.binding->entries;
  CHECK(bound.binding->types(PerformKind::kMotion) ==
        Strings{"going", "looking", "detecting", "signalling"});
  CHECK(bound.binding->types(PerformKind::kAction) ==
        Strings{"picking-up", "placing", "opening", "accessing", "closing", "sealing", "navigating",
                "turning-towards", "detecting"});
  CHECK(entries[0].event_symbol == "Go");
  CHECK(entries[0].time_offset == 1);
  CHECK(entries[0].failure_class == "navigation-pose-unreachable");
  CHECK(bound.files.text(entries[0].formula_source) == "RobotAt(region(?p))");
  const auto& detecting = entries[2];
  CHECK(detecting.time_offset == 0);
  CHECK(detecting.returns == "i");
  CHECK(detecting.failure_class == "perception-object-not-found");
  CHECK(detecting.keys[0].property == "type");
  CHECK(bound.files.text(detecting.formula_source) == "exists i. TypeOf(i,?y) & Visible(i)");
  const auto& placing = entries[4];
  REQUIRE(placing.keys.size() == 3);
  CHECK(placing.keys[0].variable == "?a");
  CHECK(placing.keys[1].variable == "?o");
  CHECK(placing.keys[2].variable == "?p");
  CHECK(entries.back().type == "detecting");
  CHECK(entries.back().kind == PerformKind::kAction);
  CHECK(entries.back().event_symbol == "Detect");
}

TEST_CASE("binding: comments and line layout do not matter") {
  const auto bound = read_table(
      "; a comment with action and motion\nmotion going (:pose ?where)\n->\nGo(region(?where)) ; "
      "to there\n  ok:\n RobotAt(region(?where))@t+1");
  CHECK(errors(bound).empty());
  REQUIRE(bound.binding.has_value());
  CHECK(bound.binding->entries[0].keys[0].key == "target");
  CHECK(bound.binding->entries[0].failure_class == "simple-plan-failure");
}

TEST_CASE("binding: mistakes are located, several per run") {
  struct Case {
    std::string text;
    std::string errors;
  };
  const Case cases[] = {
      {"walking (:target ?p)",
       "E4001 1:1 expected an entry that starts with `motion`, `action`, `query`, `goal` or "
       "`object`, "
       "found `walking`\n"},
      {"query held (o) ok: F(?o) @t", "E4001 1:13 expected a variable such as `?o`, found `o)`\n"},
      {"query held (?o) ok: F(?o) @t+1",
       "E4001 1:31 expected a formula `@t`, not `@t+1`, before, found the end of the entry\n"},
      {"query held (?o) ok: F(?x) @t", "E4003 1:21 the keys bind no variable `?x`\n"},
      {"query held (?o) ok: F(?o) @t\nquery held (?x) ok: G(?x) @t",
       "E4002 2:1 query `held` with the same keys is bound twice\n"},
      {"object (:type ?y) ok: F(?o) @t else x",
       "E4001 1:32 expected `returns` and the variable that stands for the object, found `else`\n"},
      {"object (:type ?y) ok: F(?z) @t returns ?o", "E4003 1:23 the keys bind no variable `?z`\n"},
      {"action fetching (:object ?o) -> plan fetch(?x)",
       "E4003 1:1 the keys bind no variable `?x`\n"},
      {"action fetching (:object ?o) -> plan fetch(?o) ok: F(?o) @t",
       "E4001 1:48 expected the next entry, found `ok:`\n"},
      {"motion going (:target ?p) Go(?p)", "E4001 1:27 expected `->`, found `Go(?p)`\n"},
      {"motion going (:target ?p) -> Go(?p) else x",
       "E4001 1:37 expected `ok:` and the formula of success, found `else`\n"},
      {"motion going (:target ?p) -> Go(?p) ok: F(?p) else x",
       "E4001 1:53 expected `@t` or `@t+1` behind the formula, found the end of the entry\n"},
      {"motion going (:target ?p) -> Go(?p) ok: F(?p) @t+2",
       "E4001 1:49 expected `@t` or `@t+1`, found `+2`\n"},
      {"motion going (:target ?p) -> Go(?p) ok: @t",
       "E4001 1:41 expected a formula before `@`, found `@t`\n"},
      {"motion going (:target ?p -> Go(?p) ok: F() @t",
       "E4001 1:26 expected a key such as `:target`, found `->`\n"},
      {"motion going (:target ?p) -> Go(?q) ok: F(?r) @t",
       "E4003 1:1 the keys bind no variable `?q`\nE4003 1:41 the keys bind no variable `?r`\n"},
      {"motion going (:target ?p) -> Go(region(x)) ok: F() @t",
       "E4001 1:33 expected one variable as the argument of a mapping function, found something "
       "else\n"},
      {"motion a -> E() ok: F() @t\nmotion a -> G() ok: F() @t",
       "E4002 2:1 motion `a` with the same keys is bound twice\n"},
      {"motion a = b", "E4004 1:12 the alias names `b`, which has no binding\n"},
      {"action opening|accessing / closing -> Open / Close",
       "E4001 1:26 expected `(`, `->` or `=`, found `/`\n"},
      {"motion a -> E(x,) ok: F() @t\nmotion b -> G( ok: F() @t",
       "E4001 1:17 expected an argument of the event, found `)`\n"
       "E4001 2:26 expected `)`, found the end of the entry\n"},
  };
  for (const auto& one : cases) {
    CAPTURE(one.text);
    const auto bound = read_table(one.text);
    CHECK_FALSE(bound.binding.has_value());
    CHECK(errors(bound) == one.errors);
  }
}

TEST_CASE("binding: what always succeeds has no failure") {
  const auto table = std::string("action parking -> Park() ok: always\n") + std::string(kBinding);
  CHECK(errors(read_table(table)).empty());
  const auto plan = unroll(prelude() + "(perform (an action (type parking)))(go1)", {}, table);
  REQUIRE(plan.codes().empty());
  CHECK(plan.events("++") == Strings{"Park()", "Go(r1)", "DONE"});
  CHECK(plan.target(plan.graph->locations[LocationId(0)].on_failure) == "NEVER");
  for (const auto* tail : {"else plan-failure", "on slipped plan-failure", "returns i"}) {
    CAPTURE(tail);
    CHECK(errors(read_table("action parking -> Park() ok: always " + std::string(tail)))
              .find("E4001 1:37 expected the next entry, as what always succeeds") == 0);
  }
}

TEST_CASE("binding: no prefix of the table crashes the parser") {
  for (std::size_t length = 0; length < kBinding.size(); length += 3) {
    const auto bound = read_table(kBinding.substr(0, length));
    CHECK(bound.binding.has_value() != bound.sink.has_errors());
  }
}

TEST_CASE("binding: reasons of the simulator and the conditions that they raise") {
  const auto bound = read_table(
      "action picking-up (:object ?o) -> PickUp(?o) ok: Holding(?o) @t+1\n"
      "  else manipulation-pose-unreachable\n"
      "  on slipped gripper-goal-not-reached ; on out-of-reach manipulation-pose-unreachable\n"
      "action opening (:object ?o) -> Open(?o) ok: IsOpen(?o) @t+1 else plan-failure\n");
  CHECK(errors(bound).empty());
  REQUIRE(bound.binding.has_value());
  const auto& reasons = bound.binding->entries[0].reasons;
  REQUIRE(reasons.size() == 2);
  CHECK(reasons[0].reason == "slipped");
  CHECK(reasons[0].failure_class == "gripper-goal-not-reached");
  CHECK(bound.files.text(reasons[1].source) == "manipulation-pose-unreachable");
  CHECK(bound.binding->entries[1].reasons.empty());
}

TEST_CASE("binding: what is wrong with a reason is said at its place") {
  const std::string head = "motion going -> Go() ok: There() @t+1 else plan-failure ";
  CHECK(errors(read_table(head + "on\n")) ==
        "E4001 2:1 expected a reason of the simulator, found the end of the entry\n");
  CHECK(errors(read_table(head + "on blocked\n")) ==
        "E4001 2:1 expected a failure class, found the end of the entry\n");
  CHECK(errors(read_table(head + "on blocked plan-failure on blocked plan-failure\n")) ==
        "E4001 1:84 expected a reason once, found `blocked` a second time\n");
  CHECK(errors(read_table("object (:type ?y) ok: Kind(?o,?y) @t returns ?o on x plan-failure\n"))
            .starts_with("E4001"));
}

}  // namespace
}  // namespace parallax::compiler
