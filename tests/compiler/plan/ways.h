#pragma once

#include <doctest/doctest.h>

#include <set>
#include <string>
#include <utility>
#include <variant>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {

/// The plan after the prelude, its branches by turns.
inline Unrolled by_turns(const std::string& text) {
  UnrollOptions options;
  options.interleave = true;
  return unroll(prelude() + text, options);
}

/// The event sequences of all ways through the graph on which the performs with the events of
/// `failing` fail and all others succeed; each ends with its terminal.
class Ways {
 public:
  Ways(const Unrolled& plan, std::set<std::string> failing = {})
      : plan_(plan), failing_(std::move(failing)) {
    follow(plan.graph->entry, "");
  }
  std::set<std::string> all;

 private:
  void follow(const PlanTarget& target, const std::string& before) {
    REQUIRE(before.size() < 1000);
    if (const auto* id = std::get_if<LocationId>(&target)) {
      const auto& location = plan_.graph->locations[*id];
      const bool fails = failing_.contains(location.event.text);
      follow(fails ? location.on_failure : location.on_success, before + location.event.text + " ");
    } else if (const auto* branch = std::get_if<BranchId>(&target)) {
      REQUIRE(plan_.graph->branches[*branch].free);
      follow(plan_.graph->branches[*branch].if_true, before);
      follow(plan_.graph->branches[*branch].if_false, before);
    } else if (const auto end = plan_.target(target); end != "NEVER") {
      all.insert(before + end);
    }
  }
  const Unrolled& plan_;
  std::set<std::string> failing_;
};

}  // namespace parallax::compiler
