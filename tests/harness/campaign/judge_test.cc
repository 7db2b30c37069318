// Judgements of observations made by hand, and the causes they state.

#include "harness/campaign/judge.h"

#include <doctest/doctest.h>

#include "tests/harness/campaign/named_trace.h"

namespace parallax::harness {
namespace {

Region cell(std::string name, double lower, double upper) {
  Region region;
  region.name = std::move(name);
  region.on(RegionAxis::kX) = Interval{lower, upper};
  return region;
}

/// A box on a line of two cells, a drawer that is open, closed, or half open, and a mood.
StateMapping mapping() {
  base::DiagnosticSink sink;
  auto regions = RegionSet::make({cell("r1", 0, 1), cell("r2", 1, 2)}, false, sink);
  REQUIRE(regions.has_value());
  return StateMapping(*regions,
                      {{"BoxIn", 1, InsideBinding{"box", 0, "box.held", {}}, {}},
                       {"Held", 0, FlagBinding{"box.held"}, {}},
                       {"Open", 0, RangeBinding{"drawer.q", {0.3, 0.5}, {0.0, 0.1}, 0.0}, {}},
                       {"On", 1, EqualsBinding{"lamp", "{0}"}, {}},
                       {"Tired", 0, IgnoredBinding{}, {}},
                       {"LookingAt", 1, IgnoredBinding{}, {}}});
}

test::Table table() {
  return test::table_of({"Tired()", "BoxIn(r2)", "BoxIn(r1)", "Held()", "LookingAt(r1)",
                         "LookingAt(r2)", "On(red)", "Open()"});
}
ModelFluents fluents() { return ModelFluents(*table()); }

/// A trace from r2 over the gripper to r1.
CampaignTrace trace() {
  return test::named_trace(1, {}, {{"BoxIn(r2)", "Tired()"}, {"Held()"}, {"BoxIn(r1)"}},
                           {{"PickUp(box)"}, {"Place(r1)"}}, table());
}

State state(double box_m, bool held, double drawer_m = 0.0) {
  return {{"box.x", box_m},
          {"box.held", held},
          {"drawer.q", drawer_m},
          {"lamp", std::string("off")},
          {"digest", std::string("ab")}};
}

const std::vector<ActionOutcome> kDone = {{SimStatus::kOk, "", 1.0}, {SimStatus::kOk, "", 2.0}};

Judgement judged(const std::vector<State>& observations) {
  return judge(mapping(), fluents(), trace(), observations);
}

TEST_CASE("observations that say what the trace says match, whatever is ignored") {
  const auto judgement = judged({state(1.5, false), state(1.5, true), state(0.5, false)});
  CHECK(judgement.matches(Comparison::kEveryStep));
  CHECK(judgement.matches(Comparison::kFinal));
  CHECK_FALSE(judgement.first_divergence.has_value());
  CHECK_FALSE(judgement.parted.has_value());
  CHECK(judgement.missing.empty());
  CHECK_FALSE(judgement.states.back().in_no_state);
  REQUIRE(judgement.states.size() == 3);
  std::map<std::string, bool> last;
  for (const auto& [id, holds] : judgement.states.back().holds) last[table()->name(id)] = holds;
  CHECK(last == std::map<std::string, bool>{{"BoxIn(r1)", true},
                                            {"BoxIn(r2)", false},
                                            {"Held()", false},
                                            {"On(red)", false},
                                            {"Open()", false}});
}

TEST_CASE("a start that is another one diverges at timepoint 0, even if the end is right") {
  const auto judgement = judged({state(0.5, false), state(1.5, true), state(0.5, false)});
  CHECK_FALSE(judgement.matches(Comparison::kEveryStep));
  CHECK(judgement.matches(Comparison::kFinal));
  CHECK(judgement.first_divergence == 0);
  REQUIRE(judgement.first.size() == 2);
  CHECK(judgement.first[0].fluent == "BoxIn(r1)");
  CHECK_FALSE(judgement.first[0].predicted);
  CHECK(judgement.first[0].observed);
  CHECK(judgement.first[1].fluent == "BoxIn(r2)");
  CHECK_FALSE(judgement.parted.has_value());
}

TEST_CASE("what differs at the end, where it began to, and the action that failed there") {
  const auto judgement = judged({state(1.5, false), state(1.5, false), state(1.5, false)});
  CHECK_FALSE(judgement.matches(Comparison::kEveryStep));
  CHECK_FALSE(judgement.matches(Comparison::kFinal));
  CHECK(judgement.first_divergence == 1);
  CHECK(judgement.parted == 1);
  // That nothing is held differs as well, but not at the end.
  REQUIRE(judgement.first.size() == 2);
  REQUIRE(judgement.at_parting.size() == 1);
  CHECK(judgement.at_parting[0].fluent == "BoxIn(r2)");
  REQUIRE(judgement.last.size() == 2);
  CHECK(judgement.last[0].fluent == "BoxIn(r1)");
  CHECK(judgement.last[0].timepoint == 2);

  auto outcomes = kDone;
  CHECK(cause_of(trace(), judgement, Comparison::kFinal, outcomes).text ==
        "PickUp(box): BoxIn(r2)");
  CHECK(cause_of(trace(), judgement, Comparison::kFinal, outcomes).reason.empty());
  outcomes[0] = {SimStatus::kFailed, "slipped: 3 N", 1.0};
  CHECK(cause_of(trace(), judgement, Comparison::kFinal, outcomes).text == "PickUp(box): slipped");
  CHECK(cause_of(trace(), judgement, Comparison::kFinal, outcomes).reason == "slipped: 3 N");
  outcomes[0] = {SimStatus::kTruncated, "", 1.0};
  CHECK(cause_of(trace(), judgement, Comparison::kFinal, outcomes).text ==
        "PickUp(box): truncated");
}

TEST_CASE("a simulation that comes back has not parted before it leaves for good") {
  const auto judgement = judged({state(1.5, false), state(0.5, false), state(0.5, true)});
  CHECK(judgement.first_divergence == 1);
  CHECK(judgement.parted == 1);
  const auto back = judged({state(1.5, false), state(0.5, false), state(0.5, false)});
  CHECK(back.matches(Comparison::kFinal));
  CHECK_FALSE(back.matches(Comparison::kEveryStep));
  CHECK(cause_of(trace(), back, Comparison::kEveryStep, kDone).text == "PickUp(box): BoxIn(r1)");
  CHECK(back.first_divergence == 1);
  CHECK_FALSE(back.parted.has_value());
}

TEST_CASE(
    "a body beyond all regions and a value between two intervals are no states of the model") {
  // The trace puts the box somewhere, so that fluent differs and the body is not named once more.
  const auto beyond = judged({state(1.5, false), state(1.5, true), state(7.0, false)});
  REQUIRE(beyond.last.size() == 1);
  CHECK(beyond.last[0].fluent == "BoxIn(r1)");
  const auto dropped = judged({state(1.5, false), state(7.0, false), state(0.5, false)});
  REQUIRE(dropped.first.size() == 2);
  CHECK(dropped.first[0].fluent == "Held()");
  CHECK(dropped.first[1].fluent == "BoxIn(outside)");
  CHECK(dropped.first[1].observed);
  const auto half_open = judged({state(1.5, false), state(1.5, true), state(0.5, false, 0.2)});
  CHECK(half_open.states.back().in_no_state);
  CHECK_FALSE(half_open.states[1].in_no_state);
  REQUIRE(half_open.last.size() == 1);
  CHECK(half_open.last[0].fluent == "Open()");
  CHECK_FALSE(half_open.last[0].predicted);
  CHECK(half_open.last[0].observed);
}

TEST_CASE("variables that are not there are named") {
  auto last = state(0.5, false);
  last.erase("drawer.q");
  last["lamp"] = 3.0;
  const auto judgement = judged({state(1.5, false), state(1.5, true), last});
  CHECK(judgement.missing == std::set<std::string>{"drawer.q", "lamp"});
}

TEST_CASE("without events the cause is the start") {
  const auto only = test::named_trace(1, {}, {{"BoxIn(r2)", "Tired()"}}, {}, table());
  const auto judgement = judge(mapping(), fluents(), only, {state(0.5, false)});
  CHECK(cause_of(only, judgement, Comparison::kEveryStep, {}).text == "start: BoxIn(r1)");
}

TEST_CASE("how symbols are compared is listed once, and the rest of a state is what is compared") {
  using How = ComparedFluents::How;
  std::vector<std::pair<std::string, How>> listed;
  for (const auto& [fluent, how, why] :
       compared_fluents(mapping(), fluents().ground(), Comparison::kEveryStep)) {
    listed.emplace_back(fluent, how);
  }
  CHECK(listed == std::vector<std::pair<std::string, How>>{{"BoxIn(..)", How::kEveryStep},
                                                           {"Held()", How::kEveryStep},
                                                           {"LookingAt(..)", How::kIgnored},
                                                           {"On(..)", How::kEveryStep},
                                                           {"Open()", How::kEveryStep},
                                                           {"Tired()", How::kIgnored}});
  const auto last = compared_fluents(mapping(), fluents().ground(), Comparison::kFinal);
  CHECK(last[0].how == How::kAtTheEnd);
  CHECK(last[2].how == How::kIgnored);
  CHECK(mapped_part(mapping(), fluents().ground(), state(0.5, true)) ==
        State{{"box.held", true}, {"box.x", 0.5}, {"drawer.q", 0.0}, {"lamp", std::string("off")}});
}

}  // namespace
}  // namespace parallax::harness
