// Forms that describe the world around the robot do nothing, and docs/reference/plan_language.md
// lists all of them.
#include "compiler/interpreter/world_forms.h"

#include <doctest/doctest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

/// The words in backquotes of the row of the table that begins with this cell.
std::set<std::string> listed(const std::string& row) {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/docs/reference/plan_language.md");
  std::set<std::string> out;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| " + row + " |")) continue;
    for (auto at = line.find('`'); at != std::string::npos; at = line.find('`', at + 1)) {
      const auto end = line.find('`', at + 1);
      REQUIRE(end != std::string::npos);
      out.insert(line.substr(at + 1, end - at - 1));
      at = end;
    }
  }
  REQUIRE(!out.empty());
  return out;
}

std::set<std::string> named(std::span<const std::string_view> names) {
  return {names.begin(), names.end()};
}

TEST_CASE("no-ops: the page lists what the program knows, and nothing else") {
  CHECK(listed("forms without effect") == named(ignored_forms()));
  CHECK(listed("packages without effect") == named(ignored_packages()));
  CHECK(listed("functions without effect") == named(ignored_functions()));
  CHECK(listed("forms that are their body") == named(transparent_forms()));
}

TEST_CASE(
    "no-ops: with any prefix, their arguments are not evaluated, and nothing in them performs") {
  for (const auto name : ignored_forms()) {
    const std::string form(name);
    CAPTURE(form);
    const auto plan = unroll(prelude() + "(defun main () (sig) (" + form +
                             " (unknown function) #'f (make-instance 'e :a 1)) (go1))");
    CHECK(plan.codes().empty());
    REQUIRE(plan.graph.has_value());
    CHECK(plan.events("++") == Strings{"Signal()", "Go(r1)", "DONE"});
    CHECK(unroll(prelude() + "(defun main () (sig) (" + form + " (list (perform 1))))")
              .has("CPL013"));
  }
  for (const auto name : ignored_packages()) {
    const auto call = fmt::format("({}::whatever (unknown))", name);
    CHECK(unroll(prelude() + call + "(sig)").codes().empty());
    CHECK(unroll(prelude() + fmt::format("({}:f (perform 1))", name)).has("CPL013"));
  }
  for (const auto name : ignored_functions()) {
    CHECK(unroll(prelude() + fmt::format("({} 1 (unknown))(sig)", name)).codes().empty());
  }
  for (const auto name : transparent_forms()) {
    const auto plan = unroll(prelude() + fmt::format("({} (x) (sig) (go1))", name));
    CHECK(plan.codes().empty());
    CHECK(plan.events("++") == Strings{"Signal()", "Go(r1)", "DONE"});
  }
  CHECK(unroll(prelude() + "(roslisp:ros-info (a b) \"~a\" x)(cpl:sleep 1)(sig)").codes().empty());
  // Without the package they are unknown, and so are other functions of those packages.
  CHECK(unroll("(spawn-object 1)").has("CPL010"));
  CHECK(unroll("(btr:robot-state 1)").has("CPL010"));
}

TEST_CASE("no-ops: a function of the plan goes first") {
  const auto plan = unroll(prelude() + "(defun clear () (sig))(clear)");
  CHECK(plan.events("+") == Strings{"Signal()", "DONE"});
}

}  // namespace
}  // namespace parallax::compiler
