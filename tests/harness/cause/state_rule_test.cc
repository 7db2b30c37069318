// Initial states that make simulations fail, from runs of which it is known.

#include "harness/cause/state_rule.h"

#include <doctest/doctest.h>

#include "harness/cause/cause_kind.h"

namespace parallax::test {
namespace {

using harness::StateRun;

/// Runs from the places of a trolley and of a vase in turn.
std::vector<StateRun> ward_runs(int count, bool (*failed)(bool on_way, bool on_table)) {
  std::vector<StateRun> out;
  for (int i = 0; i < count; ++i) {
    const bool on_way = i % 3 == 0, on_table = i % 2 == 0;
    out.push_back({{on_way ? "TrolleyAt(onWay)" : "TrolleyAt(byWall)",
                    on_table ? "VaseAt(onTable)" : "VaseAt(onSill)", "Parked()"},
                   failed(on_way, on_table)});
  }
  return out;
}

TEST_CASE("one fluent that decides is found, with its counts") {
  const auto runs = ward_runs(30, [](bool on_way, bool) { return on_way; });
  const auto rule = harness::state_rule(runs);
  REQUIRE(rule);
  CHECK(rule->is_exact());
  CHECK(harness::state_words(*rule) ==
        "It fails where `TrolleyAt(onWay)` at the start: 10 of 10 runs, elsewhere 0 of 20.");
  harness::CauseFinding finding;
  harness::weigh_states(runs, finding);
  CHECK(finding.kind == harness::CauseKind::kState);
}

TEST_CASE("two fluents that decide together are found") {
  const auto rule = harness::state_rule(
      ward_runs(60, [](bool on_way, bool on_table) { return on_way && on_table; }));
  REQUIRE(rule);
  CHECK(rule->is_exact());
  CHECK(rule->literals.size() == 2);
  CHECK(rule->failures == 10);
}

TEST_CASE("too few runs, failures everywhere and chance tell nothing") {
  CHECK_FALSE(harness::state_rule({}));
  CHECK_FALSE(harness::state_rule(ward_runs(3, [](bool on_way, bool) { return on_way; })));
  CHECK_FALSE(harness::state_rule(ward_runs(30, [](bool, bool) { return true; })));
  CHECK_FALSE(harness::state_rule(ward_runs(30, [](bool, bool) { return false; })));
  auto runs = ward_runs(24, [](bool, bool) { return false; });
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].failed = i % 5 == 0;
  CHECK_FALSE(harness::state_rule(runs));
}

TEST_CASE("a state in which it fails now and then is told, but is not the whole cause") {
  auto runs = ward_runs(90, [](bool on_way, bool) { return on_way; });
  for (std::size_t i = 0; i < runs.size(); i += 9) runs[i].failed = false;
  const auto rule = harness::state_rule(runs);
  REQUIRE(rule);
  CHECK(rule->failures_inside == 20);
  CHECK(rule->clean_inside == 10);
  CHECK_FALSE(rule->is_exact());
  harness::CauseFinding finding;
  harness::weigh_states(runs, finding);
  CHECK(finding.kind == harness::CauseKind::kUnknown);
}

}  // namespace
}  // namespace parallax::test
