#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "runtime/enumerate/canonical.h"
#include "runtime/graph/orbit_number.h"
#include "runtime/graph/orbit_traces.h"
#include "runtime/graph/trace_count.h"
#include "runtime/symmetry/permutation_check.h"
#include "tests/runtime/symmetry/symmetric_traces.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

std::vector<std::vector<std::string>> sets_of(const std::string& text) {
  TextModel model(text);
  REQUIRE_MESSAGE(!model.sink.has_errors(), model.codes());
  return runtime::ModelSymmetry(model.compiled).constants().sets;
}

using Sets = std::vector<std::vector<std::string>>;

const std::string kThings =
    "range time 0 2\nsort thing\nthing A, B, C\nfluent Held(thing)\nevent Take(thing)\n"
    "[thing,time] Initiates(Take(thing),Held(thing),time).\n";

TEST_CASE("constants that no axiom names are interchangeable") {
  CHECK(sets_of(kThings) == Sets{{"A", "B", "C"}});
}

TEST_CASE("one that an axiom names is not") {
  CHECK(sets_of(kThings + "!HoldsAt(Held(B),0).\n") == Sets{{"A", "C"}});
  CHECK(sets_of(kThings + "{thing} thing!=A & HoldsAt(Held(thing),2).\n") == Sets{{"B", "C"}});
  CHECK(sets_of(kThings + "[time] Happens(Take(A),time) -> HoldsAt(Held(B),time).\n").empty());
}

TEST_CASE("two that an axiom names alike are") {
  CHECK(sets_of(kThings + "!HoldsAt(Held(A),0).\n!HoldsAt(Held(C),0).\n") == Sets{{"A", "C"}});
  CHECK(sets_of(kThings + "HoldsAt(Held(A),0) | HoldsAt(Held(B),0).\n") == Sets{{"A", "B"}});
}

TEST_CASE("values of functions tell constants apart, and equal values do not") {
  const std::string weights =
      "sort number: integer\nrange number 0 3\nfunction Weight(thing): number\n";
  const std::string heavy = "[thing,time] Weight(thing)>1 -> !Happens(Take(thing),time).\n";
  CHECK(sets_of(kThings + weights + "Weight(A)=1.\nWeight(B)=2.\nWeight(C)=1.\n" + heavy) ==
        Sets{{"A", "C"}});
  CHECK(sets_of(kThings + weights + "Weight(A)=1.\nWeight(B)=1.\nWeight(C)=1.\n" + heavy) ==
        Sets{{"A", "B", "C"}});
  // An order between constants by their values.
  const std::string order =
      "[thing1,thing2,time] Weight(thing1)<Weight(thing2) & HoldsAt(Held(thing2),time) -> "
      "HoldsAt(Held(thing1),time).\n";
  CHECK(sets_of(kThings + weights + "Weight(A)=1.\nWeight(B)=2.\nWeight(C)=3.\n" + order).empty());
}

TEST_CASE("things that differ by a fact are told apart by it, however much is said of them") {
  std::string text =
      "range time 0 2\nsort thing\nsort place\nthing A, B\nplace P1, P2, P3, P4, P5, P6, P7, P8\n"
      "fluent At(thing,place)\nevent Put(thing,place)\n"
      "[thing,place,time] Initiates(Put(thing,place),At(thing,place),time).\n"
      "[thing,place1,place2,time]\n"
      "  HoldsAt(At(thing,place1),time) & HoldsAt(At(thing,place2),time) -> place1=place2.\n"
      "HoldsAt(At(A,P1),0).\nHoldsAt(At(B,P2),0).\n";
  const TextModel model(text);
  REQUIRE(model.codes() == "");
  const runtime::NamedAtoms atoms(model.compiled);
  const auto number = [&](const std::string& name) {
    const auto& all = atoms.constants();
    return static_cast<std::uint32_t>(std::find(all.begin(), all.end(), name) - all.begin());
  };
  const auto exchange = [&](std::uint32_t one, std::uint32_t other) {
    runtime::ConstantMap map(atoms.constants().size());
    std::iota(map.begin(), map.end(), 0U);
    std::swap(map[one], map[other]);
    return map;
  };
  runtime::PermutationCheck check(model.compiled, atoms);
  const auto a = number("A"), b = number("B");
  CHECK(check.signature(a) == check.signature(b));
  CHECK(!check.is_symmetric(exchange(a, b)));
  CHECK(check.work() <= 2);
  const auto before = check.work();
  CHECK(check.is_symmetric(exchange(number("P3"), number("P4"))));
  CHECK(check.work() > before + 20);
}

TEST_CASE("numbers are never exchanged") {
  CHECK(sets_of("range time 0 1\nsort level: integer\nrange level 1 3\nfluent At(level)\n"
                "event Go(level)\n[level,time] Initiates(Go(level),At(level),time).\n")
            .empty());
}

TEST_CASE("constants of several sorts, in nested terms and beside each other") {
  const std::string text =
      "range time 0 1\nsort agent\nsort room\nagent Ann, Bob\nroom R1, R2, R3\n"
      "fluent Sees(agent,agent)\nfluent In(agent,room)\nevent Go(agent,room)\n"
      "[agent,room,time] Initiates(Go(agent,room),In(agent,room),time).\n";
  CHECK(sets_of(text) == Sets{{"Ann", "Bob"}, {"R1", "R2", "R3"}});
  CHECK(sets_of(text + "[agent,time] HoldsAt(Sees(agent,agent),time).\n") ==
        Sets{{"Ann", "Bob"}, {"R1", "R2", "R3"}});
  CHECK(sets_of(text + "HoldsAt(Sees(Ann,Bob),0).\n") == Sets{{"R1", "R2", "R3"}});
  CHECK(sets_of(text + "HoldsAt(Sees(Ann,Bob),0).\nHoldsAt(Sees(Bob,Ann),0).\n") ==
        Sets{{"Ann", "Bob"}, {"R1", "R2", "R3"}});
}

TEST_CASE("what stands below definitions is mapped along with them") {
  const std::string text =
      kThings +
      "[time] ({thing} HoldsAt(Held(thing),time) & Happens(Take(thing),time)) | ({thing1,thing2} "
      "thing1!=thing2 & !HoldsAt(Held(thing1),time) & !HoldsAt(Held(thing2),time)) | "
      "({thing} !Happens(Take(thing),time) & HoldsAt(Held(thing),time+1)).\n";
  CHECK(sets_of(text) == Sets{{"A", "B", "C"}});
}

std::vector<std::vector<std::vector<std::string>>> together_in(const std::string& text) {
  TextModel model(text);
  REQUIRE_MESSAGE(!model.sink.has_errors(), model.codes());
  return runtime::ModelSymmetry(model.compiled).constants().together;
}

/// Rooms in a row, with a door between neighbours.
std::string row_of_rooms(int rooms, bool is_ring) {
  const auto name = [&](const char* letter, int i) { return letter + std::to_string(i); };
  std::string text = "range time 0 2\nsort room\nsort door\nroom R1";
  for (int i = 2; i <= rooms; ++i) text += ", " + name("R", i);
  text += "\ndoor D1";
  const auto doors = is_ring ? rooms : rooms - 1;
  for (int i = 2; i <= doors; ++i) text += ", " + name("D", i);
  text +=
      "\nfluent In(room)\nfluent Open(door)\nevent Go(door)\nevent Turn(door)\n"
      "[door,time] Initiates(Turn(door),Open(door),time).\n"
      "[door,time] Happens(Go(door),time) -> HoldsAt(Open(door),time).\n"
      "[room1,room2,time] HoldsAt(In(room1),time) & HoldsAt(In(room2),time) -> room1=room2.\n"
      "[time] {room} HoldsAt(In(room),time).\n";
  for (int i = 1; i <= doors; ++i) {
    const auto a = name("R", i), b = name("R", i % rooms + 1), door = name("D", i);
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      const auto at = "[time] HoldsAt(In(" + from + "),time) -> ";
      text += at + "Initiates(Go(" + door + "),In(" + to + "),time).\n";
      text += at + "Terminates(Go(" + door + "),In(" + from + "),time).\n";
    }
  }
  return text;
}

TEST_CASE("a row of rooms is mirrored with its doors, unless something is said of an end") {
  const auto row = row_of_rooms(5, false);
  CHECK(sets_of(row).empty());
  CHECK(together_in(row) == std::vector<std::vector<std::vector<std::string>>>{
                                {{"R1", "R5"}, {"R2", "R4"}, {"D1", "D4"}, {"D2", "D3"}}});
  CHECK(together_in(row + "HoldsAt(In(R3),0).\n").size() == 1);
  CHECK(together_in(row + "HoldsAt(In(R1),0).\n").empty());
  CHECK(together_in(row + "!HoldsAt(Open(D2),0).\n").empty());
  CHECK(together_in(row + "!HoldsAt(Open(D2),0).\n!HoldsAt(Open(D3),0).\n").size() == 1);
}

TEST_CASE("a ring of rooms has a symmetry for each room and direction") {
  TextModel ring(row_of_rooms(6, true));
  REQUIRE(!ring.sink.has_errors());
  const runtime::ModelSymmetry symmetry(ring.compiled);
  CHECK(symmetry.group().order() == 12);
  CHECK(symmetry.known_order() == 12);
  TextModel named(row_of_rooms(6, true) + "HoldsAt(In(R2),0).\n");
  CHECK(runtime::ModelSymmetry(named.compiled).group().order() == 2);
}

TEST_CASE("twins in pairs of rooms: exchanges within exchanges") {
  std::string text =
      "range time 0 1\nsort room\nsort lamp\nroom R1, R2, R3\nlamp L11, L12, L21, L22";
  text +=
      ", L31, L32\nfluent On(lamp)\nfluent Bright(room)\nevent Press(lamp)\n"
      "[lamp,time] Initiates(Press(lamp),On(lamp),time).\n";
  for (const std::string room : {"1", "2", "3"}) {
    text += "[time] HoldsAt(Bright(R" + room + "),time) <-> HoldsAt(On(L" + room +
            "1),time) | HoldsAt(On(L" + room + "2),time).\n";
  }
  TextModel model(text);
  REQUIRE_MESSAGE(!model.sink.has_errors(), model.codes());
  const runtime::ModelSymmetry symmetry(model.compiled);
  CHECK(symmetry.constants().sets == Sets{{"L11", "L12"}, {"L21", "L22"}, {"L31", "L32"}});
  CHECK(symmetry.group().order() == 48);
}

/// Many constants whose connections are as symmetric as can be.
TEST_CASE("orbits of traces with large groups are counted, not listed") {
  std::string text = "range time 0 1\nsort pigeon\nsort hole\npigeon P1";
  for (int i = 2; i <= 12; ++i) text += ", P" + std::to_string(i);
  text += "\nhole H1";
  for (int i = 2; i <= 13; ++i) text += ", H" + std::to_string(i);
  text +=
      "\nfluent In(pigeon,hole)\n[pigeon,time] {hole} HoldsAt(In(pigeon,hole),time).\n"
      "[pigeon,hole1,hole2,time] HoldsAt(In(pigeon,hole1),time) & HoldsAt(In(pigeon,hole2),time) "
      "-> hole1=hole2.\n"
      "[pigeon1,pigeon2,hole,time] HoldsAt(In(pigeon1,hole),time) & "
      "HoldsAt(In(pigeon2,hole),time) -> pigeon1=pigeon2.\n";
  TextModel model(text);
  REQUIRE(!model.sink.has_errors());
  runtime::OrbitTraces traces(model.compiled, {});
  CHECK(traces.next().has_value());
  CHECK(!traces.next().has_value());
  CHECK(traces.exhausted());
  CHECK(traces.total() == 6227020800);  // 13! ways to sit, whatever time says
}

/// The binomial coefficient n over k.
mpz_class choose(unsigned long n, unsigned long k) {
  mpz_class out;
  mpz_bin_uiui(out.get_mpz_t(), n, k);
  return out;
}

std::string list_of(const std::string& sort, char letter, int count) {
  std::string text = "sort " + sort + "\n" + sort + " ";
  for (int i = 1; i <= count; ++i) text += (i > 1 ? ", " : "") + (letter + std::to_string(i));
  return text + "\n";
}

TEST_CASE("orbits of things that know nothing of each other: multisets of their histories") {
  // A switch begins on or off, and is pressed or not at each of 6 steps: 128 histories.
  TextModel model(list_of("switch", 'S', 12) +
                  "fluent On(switch)\nevent Press(switch)\n"
                  "[switch,time] !HoldsAt(On(switch),time) -> Initiates(Press(switch),On(switch),"
                  "time).\n"
                  "[switch,time] HoldsAt(On(switch),time) -> Terminates(Press(switch),On(switch),"
                  "time).\nrange time 0 6\n");
  REQUIRE(!model.sink.has_errors());
  const runtime::ModelSymmetry symmetry(model.compiled);
  const auto number = runtime::count_orbits(model.compiled, symmetry, {});
  REQUIRE(number.has_value());
  CHECK(number->orbits == choose(128 + 12 - 1, 12));
  mpz_class all;
  mpz_ui_pow_ui(all.get_mpz_t(), 128, 12);
  CHECK(number->traces == all);
  CHECK(number->counted == 77);  // partitions of 12
}

TEST_CASE("many things that one hand moves are counted on states up to exchanging them") {
  // At each step one of 40 things is taken or put down, or nothing: with h of them held there are
  // h ways down and 40 - h up.
  constexpr int kThingCount = 40, kSteps = 12;
  TextModel model(list_of("thing", 'T', kThingCount) +
                  "fluent Held(thing)\nevent Take(thing)\nevent Drop(thing)\n"
                  "[thing,time] Initiates(Take(thing),Held(thing),time).\n"
                  "[thing,time] Terminates(Drop(thing),Held(thing),time).\n"
                  "[thing,time] Happens(Take(thing),time) -> !HoldsAt(Held(thing),time).\n"
                  "[thing,time] Happens(Drop(thing),time) -> HoldsAt(Held(thing),time).\n"
                  "[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> "
                  "event1=event2.\n"
                  "[thing] !HoldsAt(Held(thing),0).\nrange time 0 12\n");
  REQUIRE(!model.sink.has_errors());
  std::vector<mpz_class> ways(kThingCount + 1);
  ways[0] = 1;
  for (int step = 0; step < kSteps; ++step) {
    auto next = ways;
    for (int held = 0; held <= kThingCount; ++held) {
      const auto at = static_cast<std::size_t>(held);
      if (held > 0) next[at - 1] += ways[at] * held;
      if (held < kThingCount) next[at + 1] += ways[at] * (kThingCount - held);
    }
    ways = next;
  }
  const mpz_class wanted = std::accumulate(ways.begin(), ways.end(), mpz_class(0));
  const auto counted = runtime::count_traces(model.compiled, {});
  CHECK(counted.complete);
  CHECK(counted.count == wanted);
  CHECK(counted.stats.by_symmetry);
  CHECK(counted.stats.states < 100);
}

TEST_CASE("a trace whose constants stand in a ring or in a row") {
  std::string text = "range time 0 0\nsort node\nnode N1, N2, N3, N4, N5\nfluent E(node,node)\n";
  TextModel model(text);
  REQUIRE(!model.sink.has_errors());
  const runtime::ModelSymmetry symmetry(model.compiled);
  const runtime::TraceOrbits orbits(model.compiled, symmetry.group(), runtime::Compared::kObserved);
  auto symbols = runtime::symbols_of(model.compiled);
  const auto trace_of = [&](const std::vector<std::string>& edges) {
    runtime::Trace trace;
    trace.symbols = symbols;
    auto& point = trace.points.emplace_back();
    for (const auto& edge : edges) point.holds.push_back(*symbols->fluent("E(" + edge + ")"));
    std::sort(point.holds.begin(), point.holds.end());
    return trace;
  };
  const auto ring = orbits.of(trace_of({"N1,N2", "N2,N3", "N3,N4", "N4,N5", "N5,N1"}));
  const auto other = orbits.of(trace_of({"N1,N3", "N3,N5", "N5,N2", "N2,N4", "N4,N1"}));
  const auto row = orbits.of(trace_of({"N1,N2", "N2,N3", "N3,N4", "N4,N5"}));
  const auto two = orbits.of(trace_of({"N1,N2", "N2,N1", "N3,N4", "N4,N5", "N5,N3"}));
  CHECK(ring.size == 24);
  CHECK(ring.form == other.form);
  CHECK(row.size == 120);
  CHECK(two.size == 20);
  CHECK(two.form != ring.form);
}

}  // namespace
}  // namespace parallax::test
