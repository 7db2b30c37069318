#include "harness/discrete/model_simulator.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>

#include "runtime/enumerate/model_enumerator.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using harness::ModelSimulator;
using harness::SimStatus;
using harness::State;

std::shared_ptr<const harness::SteppedModel> world(const std::string& text) {
  TextModel model("range time 0 3\n" + text);
  REQUIRE_MESSAGE(model.codes().empty(), model.codes());
  auto stepped = harness::step_model("world.e", std::move(model.compiled));
  auto* made = std::get_if<std::shared_ptr<const harness::SteppedModel>>(&stepped);
  REQUIRE(made != nullptr);
  return *made;
}

/// The fluents that hold, without the digest.
std::set<std::string> holding(ModelSimulator& simulator) {
  std::set<std::string> out;
  for (const auto& [name, value] : simulator.observe()) {
    const auto* boolean = std::get_if<bool>(&value);
    if (boolean != nullptr && *boolean) out.insert(name);
  }
  return out;
}

using Names = std::set<std::string>;

constexpr const char* kLamp =
    "fluent On()\nfluent Broken()\nevent Press()\nevent Kick()\n"
    "[time] !HoldsAt(Broken(),time) -> Initiates(Press(),On(),time).\n"
    "[time] Happens(Kick(),time) -> HoldsAt(On(),time).\n";

TEST_CASE("a step has the effects of its event, and inertia does the rest") {
  ModelSimulator lamp(world(kLamp));
  CHECK(lamp.info().actions == std::vector<std::string>{"Press()", "Kick()"});
  CHECK(lamp.info().parameters.size() == 2);
  REQUIRE(lamp.reset({{"On()", false}, {"Broken()", 0.0}}, 1).status == SimStatus::kOk);
  CHECK(holding(lamp).empty());
  CHECK(lamp.act("Press()", {}, 1).status == SimStatus::kOk);
  CHECK(holding(lamp) == Names{"On()"});
  REQUIRE(lamp.reset({{"On()", false}, {"Broken()", true}}, 1).status == SimStatus::kOk);
  CHECK(lamp.act("Press()", {}, 1).status == SimStatus::kOk);
  CHECK(holding(lamp) == Names{"Broken()"});
}

TEST_CASE("an event that the model forbids fails, and only time passes") {
  ModelSimulator lamp(world(kLamp));
  REQUIRE(lamp.reset({{"On()", false}, {"Broken()", false}}, 1).status == SimStatus::kOk);
  const auto kick = lamp.act("Kick()", {}, 1);
  CHECK(kick.status == SimStatus::kFailed);
  CHECK(kick.reason == "not-possible: `world.e` has no next state in which `Kick()` has happened");
  CHECK(holding(lamp).empty());
  // Events that happen by themselves go on after a refused action: a counter that every timepoint
  // moves.
  ModelSimulator clock(
      world("fluent Late()\nfluent Locked()\nevent Tick()\nevent Open()\n"
            "[time] !HoldsAt(Late(),time) -> Happens(Tick(),time).\n"
            "[time] Initiates(Tick(),Late(),time).\n"
            "[time] Happens(Open(),time) -> !HoldsAt(Locked(),time).\n"));
  REQUIRE(clock.reset({{"Late()", false}, {"Locked()", true}}, 1).status == SimStatus::kOk);
  CHECK(clock.act("Open()", {}, 1).status == SimStatus::kFailed);
  CHECK(holding(clock) == Names{"Late()", "Locked()"});
}

TEST_CASE("events that the state or another event brings about happen, and no others") {
  ModelSimulator tub(world(
      "fluent Full()\nfluent Wet()\nfluent Loud()\nevent Fill()\nevent Spill()\nevent Cheer()\n"
      "[time] Happens(Fill(),time) & HoldsAt(Full(),time) -> Happens(Spill(),time).\n"
      "[time] Initiates(Fill(),Full(),time).\n[time] Initiates(Spill(),Wet(),time).\n"
      "[time] Initiates(Cheer(),Loud(),time).\n"));
  REQUIRE(tub.reset({{"Full()", false}, {"Wet()", false}, {"Loud()", false}}, 5).status ==
          SimStatus::kOk);
  CHECK(tub.act("Fill()", {}, 1).status == SimStatus::kOk);
  CHECK(holding(tub) == Names{"Full()"});
  CHECK(tub.act("Fill()", {}, 1).status == SimStatus::kOk);
  CHECK(holding(tub) == Names{"Full()", "Wet()"});
}

TEST_CASE("what a release leaves open is drawn from the seed, each state equally often") {
  const auto coins = world(
      "sort coin\ncoin A, B\nfluent Heads(coin)\nfluent Thrown()\nevent Throw()\n"
      "[coin,time] Releases(Throw(),Heads(coin),time).\n"
      "[time] Initiates(Throw(),Thrown(),time).\n");
  ModelSimulator first(coins), second(coins);
  std::map<Names, int> counts;
  constexpr int kThrows = 4000;
  for (std::uint64_t seed = 0; seed < kThrows; ++seed) {
    const State start = {{"Heads(A)", false}, {"Heads(B)", false}, {"Thrown()", false}};
    REQUIRE(first.reset(start, seed).status == SimStatus::kOk);
    CHECK(holding(first).empty());
    REQUIRE(first.act("Throw()", {}, 1).status == SimStatus::kOk);
    ++counts[holding(first)];
    // Bit by bit the same in another simulator, whatever either has answered before.
    if (seed % 100 != 0) continue;
    REQUIRE(second.reset(start, seed).status == SimStatus::kOk);
    REQUIRE(second.act("Throw()", {}, 1).status == SimStatus::kOk);
    CHECK(first.observe() == second.observe());
  }
  // Four outcomes of 1/4: 1000 each, and 6 standard deviations (165) are missed once in 10^8.
  REQUIRE(counts.size() == 4);
  for (const auto& [state, count] : counts) CHECK(std::abs(count - kThrows / 4) < 165);
}

TEST_CASE("starts: what is not named is drawn among the initial states that fit") {
  const auto rooms = world(
      "sort room\nroom A, B, C\nfluent In(room)\nfluent Dark()\nevent Go(room)\n"
      "[room1,room2,time] HoldsAt(In(room1),time) & HoldsAt(In(room2),time) -> room1=room2.\n"
      "[time] {room} HoldsAt(In(room),time).\n"
      "[room1,room2,time] room1!=room2 -> Terminates(Go(room1),In(room2),time).\n"
      "[room,time] Initiates(Go(room),In(room),time).\n");
  ModelSimulator simulator(rooms);
  std::map<Names, int> counts;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    REQUIRE(simulator.reset({{"Dark()", true}, {"In(A)", false}}, seed).status == SimStatus::kOk);
    ++counts[holding(simulator)];
  }
  REQUIRE(counts.size() == 2);
  for (const auto& [state, count] : counts) CHECK(std::abs(count - 300) < 75);  // 6 deviations
  const auto two = simulator.reset({{"In(A)", true}, {"In(B)", true}}, 1);
  CHECK(two.status == SimStatus::kInvalidStart);
  CHECK(two.reason == "`world.e` has no execution that starts with In(A), In(B)");
  // Facts of the start that have no part in it are not named.
  const auto dark = simulator.reset({{"Dark()", true}, {"In(A)", true}, {"In(B)", true}}, 1);
  CHECK(dark.reason == two.reason);
  CHECK(simulator.reset({{"Out()", true}}, 1).status == SimStatus::kUnsupported);
  CHECK(simulator.reset({{"Dark()", 0.5}}, 1).status == SimStatus::kUnsupported);
  REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
  CHECK(simulator.act("Fly()", {}, 1).status == SimStatus::kUnsupported);
  // More states than can be listed are reported, not drawn from a part.
  ModelSimulator small(rooms, nullptr, {.states = 2});
  const auto many = small.reset({}, 1);
  CHECK(many.status == SimStatus::kUnsupported);
  CHECK(many.reason.find("more than 2 initial states") != std::string::npos);
  CHECK(small.reset({{"In(B)", true}}, 1).status == SimStatus::kOk);
}

TEST_CASE("what the model says of single timepoints counts from the start of a run") {
  ModelSimulator quake(
      world("fluent Standing()\nevent Wait()\nevent Quake()\nHoldsAt(Standing(),0).\n"
            "Happens(Quake(),1).\n[time] Terminates(Quake(),Standing(),time).\n"));
  CHECK(quake.reset({{"Standing()", false}}, 1).status == SimStatus::kInvalidStart);
  REQUIRE(quake.reset({{"Standing()", true}}, 1).status == SimStatus::kOk);
  CHECK(quake.act("Wait()", {}, 1).status == SimStatus::kOk);
  CHECK(holding(quake) == Names{"Standing()"});
  CHECK(quake.act("Wait()", {}, 1).status == SimStatus::kOk);
  CHECK(holding(quake).empty());
  CHECK(quake.act("Wait()", {}, 1).status == SimStatus::kOk);
  // A world without such axioms goes on beyond the horizon that it was read with.
  ModelSimulator lamp(world(kLamp));
  REQUIRE(lamp.reset({}, 1).status == SimStatus::kOk);
  for (int i = 0; i < 20; ++i) CHECK(lamp.act("Press()", {}, 1).status == SimStatus::kOk);
}

TEST_CASE("a model whose axioms look further than a step is refused") {
  TextModel model(
      "range time 0 3\nfluent On()\nevent Press()\n"
      "[time] Happens(Press(),time) -> HoldsAt(On(),time+2).\n");
  const auto stepped = harness::step_model("world.e", std::move(model.compiled));
  REQUIRE(std::holds_alternative<std::string>(stepped));
  CHECK(std::get<std::string>(stepped).find("more than two neighbouring timepoints") !=
        std::string::npos);
}

TEST_CASE("the world comes to no state that its model has in no execution") {
  // Door() holds at 0, as nothing could bring it about before 1.
  ModelSimulator door(
      world("fluent Door()\nfluent Lamp()\nevent Press()\n"
            "[time] Initiates(Press(),Lamp(),time).\nHoldsAt(Door(),1).\n"));
  // Hot() has an alarm happen, which is impossible: only the last timepoint can be hot.
  ModelSimulator heat(
      world("fluent Hot()\nfluent Power()\nevent Heat()\nevent Alarm()\n"
            "[time] Releases(Heat(),Hot(),time).\n"
            "[time] HoldsAt(Hot(),time) -> Happens(Alarm(),time).\n"
            "[time] Happens(Alarm(),time) -> HoldsAt(Power(),time).\n"
            "!HoldsAt(Power(),0).\n"));
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    REQUIRE(door.reset({}, seed).status == SimStatus::kOk);
    CHECK(holding(door).contains("Door()"));
    REQUIRE(heat.reset({}, seed).status == SimStatus::kOk);
    CHECK(holding(heat).empty());
    CHECK(heat.act("Heat()", {}, 1).status == SimStatus::kOk);
    CHECK(holding(heat).empty());
    CHECK(heat.act("Heat()", {}, 1).status == SimStatus::kOk);
  }
  CHECK(door.reset({{"Door()", false}}, 1).status == SimStatus::kInvalidStart);
}

/// The states of every play of a random model are those of a trace in which the successful events
/// happen.
TEST_CASE("plays of random models are traces of them") {
  int plays = 0;
  int whole = 0;
  for (std::uint64_t seed = 1; seed <= 600 && plays < 400; ++seed) {
    const auto text = random_model(seed, kBruteForceSize).print();
    TextModel model(text);
    if (!model.ground || model.compiled.horizon < 2 || model.compiled.events.empty()) continue;
    // States with the events that lead on, of every trace.
    std::vector<std::vector<std::pair<Names, Names>>> traces;
    runtime::SolverSession session(model.compiled, runtime::make_cadical_solver());
    runtime::ModelEnumerator enumerator(session);
    while (auto trace = enumerator.next()) {
      auto& points = traces.emplace_back();
      for (std::size_t t = 0; t < trace->points.size(); ++t) {
        const auto holds = trace->holds(t), happens = trace->happens(t);
        points.push_back({{holds.begin(), holds.end()}, {happens.begin(), happens.end()}});
      }
      if (traces.size() > 20'000) break;
    }
    if (traces.empty() || traces.size() > 20'000) continue;
    auto stepped = harness::step_model("world.e", model.compiled);
    auto* made = std::get_if<std::shared_ptr<const harness::SteppedModel>>(&stepped);
    if (made == nullptr) continue;
    ModelSimulator simulator(*made);
    FuzzRandom random(seed);
    for (int play = 0; play < 4; ++play) {
      const auto start = simulator.reset({}, random.next());
      REQUIRE(start.status == SimStatus::kOk);
      std::vector<Names> states = {holding(simulator)};
      std::vector<std::string> actions;
      for (int t = 0; t < model.compiled.horizon; ++t) {
        auto action = random.pick(model.compiled.events).name;
        const bool done = simulator.act(action, {}, 1).status == SimStatus::kOk;
        actions.push_back(done ? std::move(action) : std::string());
        states.push_back(holding(simulator));
      }
      ++plays;
      if (std::find(actions.begin(), actions.end(), "") == actions.end()) ++whole;
      CAPTURE(text);
      CHECK(std::any_of(traces.begin(), traces.end(), [&](const auto& trace) {
        bool same = true;
        for (std::size_t t = 0; t < states.size() && same; ++t) {
          same = trace[t].first == states[t] && (t == actions.size() || actions[t].empty() ||
                                                 trace[t].second.contains(actions[t]));
        }
        return same;
      }));
    }
  }
  CHECK(plays > 300);
  CHECK(whole > 100);
}

}  // namespace
}  // namespace parallax::test
