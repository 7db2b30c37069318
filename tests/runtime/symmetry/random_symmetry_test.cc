#include <doctest/doctest.h>

#include <string>

#include "runtime/enumerate/canonical.h"
#include "runtime/graph/orbit_traces.h"
#include "runtime/symmetry/lex_leader.h"
#include "tests/runtime/symmetry/symmetric_traces.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

/// What most models do not tell constants apart by.
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

/// What tells some of them apart, or looks as if it did.
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
  std::size_t models = 0, symmetric = 0, unsatisfiable = 0, large = 0;
};

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
  const auto& sets = orbits.constants().sets;
  if (!sets.empty()) ++seen.symmetric;
  if (traces.empty()) ++seen.unsatisfiable;
  std::set<TraceWords> covered;
  std::size_t given = 0;
  while (const auto trace = orbits.next()) {
    const auto words = words_of(*trace, all_atoms);
    const auto orbit = orbit_of(words, sets);
    CHECK(orbits.size() == orbit.size());
    // No second representative, and what exchanges make of it are traces.
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
  runtime::SymmetryBreaker breaker(session, symmetry, order);
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
                      << " without a trace, " << seen.large << " left out");
  CHECK(seen.symmetric > 100);
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

}  // namespace
}  // namespace parallax::test
