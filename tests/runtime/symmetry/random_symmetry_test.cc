#include <doctest/doctest.h>

#include <string>

#include "runtime/enumerate/canonical.h"
#include "runtime/graph/orbit_number.h"
#include "runtime/graph/orbit_traces.h"
#include "runtime/graph/state_orbits.h"
#include "runtime/symmetry/lex_leader.h"
#include "tests/runtime/symmetry/symmetric_traces.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

/// Axioms that do not tell constants apart; most axioms of a model are drawn from these.
const std::vector<std::string> kAlike = {
    "[thing,time] Initiates(Take(thing),Held(thing),time).",
    "[thing,time] !HoldsAt(Held(thing),time) -> Initiates(Take(thing),Held(thing),time).",
    "[thing,time] HoldsAt(Held(thing),time) -> Terminates(Take(thing),Held(thing),time).",
    "[thing1,thing2,time] Happens(Take(thing1),time) & Happens(Take(thing2),time) -> "
    "thing1=thing2.",
    "[thing,place,time] Initiates(Put(thing,place),In(thing,place),time).",
    "[thing,place,time] HoldsAt(Held(thing),time) -> Terminates(Put(thing,place),In(thing,place),"
    "time).",
    "[thing,place1,place2,time] HoldsAt(In(thing,place1),time) & HoldsAt(In(thing,place2),time) "
    "-> place1=place2.",
    "[thing,time] {place} HoldsAt(In(thing,place),time).",
    "[thing1,thing2,place,time] HoldsAt(In(thing1,place),time) & HoldsAt(In(thing2,place),time) "
    "-> thing1=thing2.",
    "[thing,place,time] Happens(Put(thing,place),time) -> HoldsAt(Held(thing),time).",
    "[thing] !HoldsAt(Held(thing),0).",
    "[thing,place] !HoldsAt(In(thing,place),0).",
    "[thing,place] !Happens(Put(thing,place),0).",
    "[thing] Likes(thing) -> HoldsAt(Held(thing),0).",
    "[thing,time] Happens(Take(thing),time) -> Likes(thing).",
    "[time] ({thing} Likes(thing) & Happens(Take(thing),time)) | ({thing} Happens(Take(thing),"
    "time) & !HoldsAt(Held(thing),time)).",
    "[time] ({thing} [place] !HoldsAt(In(thing,place),time)).",
    "[thing,place,time] Releases(Take(thing),In(thing,place),time).",
    "[thing,place,time] Happens(Take(thing),time) -> !Happens(Put(thing,place),time).",
    "[time] ({thing1,thing2} thing1!=thing2 & HoldsAt(Held(thing1),time) & "
    "HoldsAt(Held(thing2),time)) | !({thing} Happens(Take(thing),time)).",
};

/// Axioms that tell some constants apart, or look as if they did.
const std::vector<std::string> kApart = {
    "!HoldsAt(Held(T1),0).",
    "HoldsAt(In(T2,P1),0).",
    "[time] Happens(Take(T2),time) -> HoldsAt(Held(T1),time).",
    "{thing} thing!=T1 & HoldsAt(Held(thing),1).",
    "HoldsAt(Held(T1),1) | HoldsAt(Held(T2),1).",
    "[place] HoldsAt(In(T1,place),0) <-> HoldsAt(In(T2,place),0).",
    "Likes(T1).",
    "Likes(T1) & Likes(T2).",
    "weight(T1)=1\nweight(T2)=2\n[thing,time] weight(thing)=2 -> !Happens(Take(thing),time).",
    "weight(T1)=1\nweight(T2)=1\n[thing1,thing2] weight(thing1)<=weight(thing2) & "
    "HoldsAt(Held(thing1),1) -> Likes(thing2).",
    "[thing,time] Happens(Take(thing),time) -> {place} place!=P2 & HoldsAt(In(thing,place),time).",
    "[number,time] Happens(Count(number),time) -> number<2.",
};

std::string model_text(FuzzRandom& random) {
  const auto things = 2 + random.below(2), places = 1 + random.below(2);
  std::string text = "range time 0 1\nsort thing\nsort place\nthing T1, T2";
  if (things > 2) text += ", T3";
  text += "\nplace P1";
  if (places > 1) text += ", P2";
  text +=
      "\nfluent Held(thing)\nfluent In(thing,place)\nevent Take(thing)\npredicate Likes(thing)\n";
  const bool puts = random.chance(50);
  bool weighs = false, counts = false;
  std::vector<std::string> chosen;
  for (std::size_t n = 1 + random.below(6); n > 0; --n) chosen.push_back(random.pick(kAlike));
  for (std::size_t n = random.below(3); n > 0; --n) chosen.push_back(random.pick(kApart));
  if (puts) text += "event Put(thing,place)\n";
  for (const auto& line : chosen) {
    if (!puts && line.find("Put") != std::string::npos) continue;
    const bool weight = line.find("weight") != std::string::npos;
    const bool count = line.find("number") != std::string::npos;
    if (weight && weighs) continue;
    if (weight && !weighs) {
      text += "sort integer\nrange integer 0 3\nfunction weight(thing): integer\n";
      if (things > 2) text += "weight(T3)=1\n";
    }
    if (count && !counts) text += "sort number: integer\nrange number 1 2\nevent Count(number)\n";
    weighs = weighs || weight;
    counts = counts || count;
    text += line + '\n';
  }
  return text;
}

struct Seen {
  std::size_t models = 0, symmetric = 0, together = 0, unsatisfiable = 0, large = 0;
  std::size_t counted = 0, folded = 0, hidden = 0;
};

/// Orbits are counted as they are listed.
void check_number(const compiler::CompiledModel& model, const runtime::TraceQuery& query,
                  std::size_t orbits, std::size_t traces, Seen& seen) {
  const runtime::ModelSymmetry symmetry(model);
  const auto number = runtime::count_orbits(model, symmetry, query);
  if (!number) return;
  CHECK(number->orbits == orbits);
  CHECK(number->traces == traces);
  ++seen.counted;
}

/// A graph with one state of each orbit counts as the whole one, on fewer states.
void check_folded_graph(const compiler::CompiledModel& model, const runtime::TraceQuery& query,
                        std::size_t traces, Seen& seen) {
  auto split = runtime::split_into_windows(model, query.distinct, runtime::FixedTies::kCarried);
  const auto* layered = std::get_if<runtime::LayeredModel>(&split);
  if (layered == nullptr || traces == 0) return;
  const auto orbits = runtime::GraphOrbits::of(model, *layered);
  if (orbits.empty()) return;
  std::string reason;
  const auto whole = runtime::TraceGraph::build(*layered, {}, nullptr, reason);
  const auto folded = runtime::TraceGraph::build(*layered, {}, nullptr, reason, &orbits);
  REQUIRE(whole != nullptr);
  REQUIRE(folded != nullptr);
  CHECK(folded->count() == traces);
  // Start states are not folded where only later states are alike.
  CHECK(folded->node_count() <= whole->node_count() + whole->starts().size());
  if (folded->node_count() < whole->node_count()) ++seen.folded;
  if (!layered->hidden.empty()) ++seen.hidden;
}

void check_orbits(const compiler::CompiledModel& model, bool all_atoms, Seen& seen) {
  const auto traces = all_traces(model, all_atoms);
  if (traces.size() > kMostTraces) {
    ++seen.large;
    return;
  }
  const std::set<TraceWords> known(traces.begin(), traces.end());
  runtime::TraceQuery query;
  if (all_atoms) query.distinct = runtime::Distinct::kAll;
  runtime::OrbitTraces orbits(model, query);
  const auto& constants = orbits.constants();
  if (!constants.empty()) ++seen.symmetric;
  if (!constants.together.empty()) ++seen.together;
  if (traces.empty()) ++seen.unsatisfiable;
  std::set<TraceWords> covered;
  std::size_t given = 0;
  while (const auto trace = orbits.next()) {
    const auto words = words_of(*trace, all_atoms);
    const auto orbit = orbit_of(words, constants);
    CHECK(orbits.size() == orbit.size());
    // No second representative, and the images of a representative under exchanges are traces.
    CHECK(!covered.contains(words));
    for (const auto& one : orbit) CHECK(known.contains(one));
    // It is the first one in canonical order.
    const auto first = std::find_if(traces.begin(), traces.end(),
                                    [&](const auto& one) { return orbit.contains(one); });
    REQUIRE(first != traces.end());
    CHECK(*first == words);
    covered.insert(orbit.begin(), orbit.end());
    ++given;
  }
  CHECK(orbits.exhausted());
  CHECK(covered == known);
  CHECK(orbits.total() == known.size());
  CHECK((given == 0) == known.empty());
  if (!constants.empty()) check_number(model, query, given, known.size(), seen);
  check_folded_graph(model, query, known.size(), seen);
}

/// The first trace is the same, and there is one in the same models.
void check_existence(const compiler::CompiledModel& model) {
  const runtime::ModelSymmetry symmetry(model);
  runtime::SolverSession plain(model, runtime::make_cadical_solver());
  runtime::ModelEnumerator canonical(plain);
  const auto first = canonical.next();
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  const auto order = runtime::whole_order(
      model, runtime::projection_blocks(model, runtime::Distinct::kObservable));
  runtime::SymmetryBreaker breaker(session, symmetry.all(), order);
  breaker.extend(order.size());
  runtime::ModelEnumerator broken(session, runtime::Distinct::kObservable,
                                  runtime::TraceOrder::kCanonical, &breaker);
  const auto same = broken.next();
  REQUIRE(first.has_value() == same.has_value());
  if (first) CHECK(words_of(*first) == words_of(*same));
  CHECK(broken.exhausted() == canonical.exhausted());
  // Those after the first are not looked for among representatives.
  CHECK(broken.next().has_value() == canonical.next().has_value());
}

TEST_CASE("random models: orbits, their sizes and existence agree with exchanging words") {
  Seen seen;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    FuzzRandom random(seed);
    const auto text = model_text(random);
    CAPTURE(text);
    TextModel model(text);
    if (model.sink.has_errors() || model.ground == nullptr) continue;
    ++seen.models;
    check_orbits(model.compiled, random.chance(40), seen);
    check_existence(model.compiled);
  }
  MESSAGE(seen.models << " models, " << seen.symmetric << " symmetric, " << seen.unsatisfiable
                      << " without a trace, " << seen.large << " left out; " << seen.counted
                      << " counted, " << seen.folded << " folded, " << seen.hidden
                      << " with hidden atoms");
  CHECK(seen.symmetric > 100);
  CHECK(seen.counted > 100);
  CHECK(seen.folded > 50);
  CHECK(seen.hidden > 5);
  CHECK(seen.symmetric + seen.large + 20 < seen.models);
  CHECK(seen.unsatisfiable > 10);
}

TEST_CASE("random models of all constructs: every exchange that is found makes traces of traces") {
  Seen seen;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const auto text = random_model(seed, kBruteForceSize).print();
    CAPTURE(text);
    TextModel model(text);
    if (model.sink.has_errors() || model.ground == nullptr) continue;
    ++seen.models;
    check_orbits(model.compiled, seed % 2 == 0, seen);
  }
  MESSAGE(seen.models << " models, " << seen.symmetric << " symmetric, " << seen.large
                      << " left out");
  CHECK(seen.symmetric > 5);
}

/// Constants that belong together by facts: the symmetries of a structure, as their cycles.
struct Planted {
  std::string facts;
  std::vector<std::vector<std::vector<std::string>>> symmetries;
};

/// Structures over things T1, T2, T3 and places P1, P2, P3.
const std::vector<Planted> kPlanted = {
    // Each thing with its own place.
    {"Own(T1,P1).\nOwn(T2,P2).\nOwn(T3,P3).\n[thing,place] Own(thing,place) -> (thing=T1 & "
     "place=P1)"
     " | (thing=T2 & place=P2) | (thing=T3 & place=P3).\n",
     {{{"T1", "T2"}, {"P1", "P2"}}, {{"T2", "T3"}, {"P2", "P3"}}}},
    // A ring in one direction, beside places that are free.
    {"[thing1,thing2] Next(thing1,thing2) <-> (thing1=T1 & thing2=T2) | (thing1=T2 & thing2=T3) | "
     "(thing1=T3 & thing2=T1).\n",
     {{{"T1", "T2", "T3"}}, {{"P1", "P2"}}}},
    // A row that can be mirrored, each with its place.
    {"[thing1,thing2] Next(thing1,thing2) <-> (thing1=T1 & thing2=T2) | (thing1=T2 & thing2=T1) | "
     "(thing1=T2 & thing2=T3) | (thing1=T3 & thing2=T2).\n"
     "[thing,place] Own(thing,place) <-> (thing=T1 & place=P1) | (thing=T2 & place=P2) | (thing=T3 "
     "& "
     "place=P3).\n",
     {{{"T1", "T3"}, {"P1", "P3"}}}},
    // Two of the things at each of two places: exchanges within exchanges.
    {"thing T4\n[thing,place] Own(thing,place) <-> ((thing=T1 | thing=T2) & place=P1) | ((thing=T3 "
     "| "
     "thing=T4) & place=P2).\n",
     {{{"T1", "T2"}}, {{"T1", "T3"}, {"T2", "T4"}, {"P1", "P2"}}}},
};

/// Axioms whose effect depends on the planted structure.
const std::vector<std::string> kTied = {
    "[thing,place,time] Happens(Put(thing,place),time) -> Own(thing,place).",
    "[thing,place,time] HoldsAt(In(thing,place),time) -> Own(thing,place).",
    "[thing1,thing2,time] Next(thing1,thing2) & HoldsAt(Held(thing1),time) -> "
    "!HoldsAt(Held(thing2),time).",
    "[thing1,thing2,time] Next(thing1,thing2) & Happens(Take(thing1),time) -> "
    "HoldsAt(Held(thing2),time+1).",
    "[thing,place,time] Own(thing,place) & Happens(Take(thing),time) -> "
    "{thing1} HoldsAt(In(thing1,place),time).",
    "[thing1,thing2,place,time] Own(thing1,place) & HoldsAt(In(thing2,place),time) & "
    "thing1!=thing2 -> "
    "HoldsAt(Held(thing1),time).",
    "[thing,place,time] !HoldsAt(In(thing,place),time) | HoldsAt(Held(thing),time).",
    "[thing1,thing2,time] Happens(Take(thing1),time) & Happens(Take(thing2),time) -> "
    "thing1=thing2.",
    "[thing,time] Initiates(Take(thing),Held(thing),time).",
    "[thing,place,time] Own(thing,place) -> Initiates(Take(thing),In(thing,place),time).",
    "[thing,place] !HoldsAt(In(thing,place),0).",
    "[thing] !HoldsAt(Held(thing),0).",
};

std::string planted_text(FuzzRandom& random, const Planted& planted, bool is_named) {
  std::string text =
      "range time 0 1\nsort thing\nsort place\nthing T1, T2, T3\nplace P1, P2, P3\n"
      "fluent Held(thing)\nfluent In(thing,place)\nevent Take(thing)\nevent Put(thing,place)\n"
      "predicate Own(thing,place)\npredicate Next(thing,thing)\n"
      "[thing,place,time] !Happens(Put(thing,place),time) | Own(thing,place).\n" +
      planted.facts;
  for (std::size_t n = 9 + random.below(6); n > 0; --n) text += random.pick(kTied) + '\n';
  if (is_named) text += random.chance(50) ? "!HoldsAt(Held(T1),1).\n" : "!Happens(Take(T3),0).\n";
  return text;
}

TEST_CASE("random models with constants that belong together: orbits, sizes and existence") {
  Seen seen;
  std::size_t named = 0;
  for (std::uint64_t seed = 1; seed <= 160; ++seed) {
    FuzzRandom random(seed);
    const auto& planted = kPlanted[seed % kPlanted.size()];
    const bool is_named = random.chance(25);
    const auto text = planted_text(random, planted, is_named);
    CAPTURE(text);
    TextModel model(text);
    if (model.sink.has_errors() || model.ground == nullptr) continue;
    ++seen.models;
    check_orbits(model.compiled, random.chance(40), seen);
    check_existence(model.compiled);
    // The planted symmetries are found: none of them maps a trace to a trace of another orbit.
    const runtime::ModelSymmetry symmetry(model.compiled);
    const auto traces = all_traces(model.compiled);
    if (traces.size() > kMostTraces) continue;
    const std::set<TraceWords> known(traces.begin(), traces.end());
    std::map<TraceWords, std::size_t> orbit;
    for (const auto& trace : traces) {
      if (orbit.contains(trace)) continue;
      const auto number = orbit.size();
      for (const auto& one : orbit_of(trace, symmetry.constants())) orbit[one] = number;
    }
    for (const auto& trace : traces) {
      for (const auto& cycles : planted.symmetries) {
        for (const auto& words : orbit_of(trace, {{}, {cycles}})) {
          if (is_named && !known.contains(words)) ++named;
          if (!is_named) CHECK(orbit[words] == orbit[trace]);
        }
      }
    }
  }
  MESSAGE(seen.models << " models, " << seen.symmetric << " symmetric, " << seen.together
                      << " of several at once, " << seen.large << " left out");
  CHECK(seen.together > 50);
  CHECK(seen.counted > 50);
  CHECK(seen.folded > 10);
  CHECK(named > 10);
}

}  // namespace
}  // namespace parallax::test
