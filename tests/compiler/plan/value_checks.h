#pragma once

#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {

/// Checks the values of expressions: (check EXPRESSION WANTED) goes to region 1 if they are equal.
/// `defined` is put before each expression.
inline void check_values(const std::vector<std::pair<std::string, std::string>>& cases,
                         const std::string& defined = {}) {
  for (const auto& one : cases) {
    const auto& expression = one.first;
    const auto& wanted = one.second;
    CAPTURE(expression);
    const auto plan =
        unroll(prelude() + defined + "(if (equal " + expression + " '" + wanted + ") (go1) (go2))");
    CHECK(plan.codes() == Strings{});
    REQUIRE(plan.graph.has_value());
    CHECK(plan.events("+") == Strings{"Go(r1)", "DONE"});
  }
}

/// The plan is refused with that code, at that line and column, with that message.
struct Refused {
  std::string plan;
  std::string_view code;
  std::string_view place;  // "line:column"
  std::string_view message;
};

inline void check_refused(const std::vector<Refused>& cases) {
  for (const auto& one : cases) {
    CAPTURE(one.plan);
    const auto plan = unroll(one.plan);
    CHECK(!plan.graph.has_value());
    REQUIRE(!plan.sink.sorted().empty());
    const auto entry = plan.sink.sorted().front();
    CHECK(base::info(entry.code).id == one.code);
    CHECK(entry.message == one.message);
    REQUIRE(entry.range.has_value());
    const auto at = plan.files[entry.range->file].position(entry.range->begin);
    CHECK(fmt::format("{}:{}", at.line, at.column) == one.place);
  }
}

}  // namespace parallax::compiler
