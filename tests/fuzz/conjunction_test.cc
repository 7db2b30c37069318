// Conjunctions of effects and other parts, some of which name atoms that do not exist.
//
// One formula of a random model has a conjunction behind its arrow. The test writes out each of its
// instances that exists as a whole, one ground formula for each conjunct, and leaves out the
// others, as docs/reference/model_language.md defines instances. Both texts must have the same
// traces. The oracles of the fuzzer read the formula as it stands.

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "tests/fuzz/differential.h"
#include "tests/fuzz/oracles.h"
#include "tests/support/random_model.h"

namespace parallax::test {
namespace {

constexpr int kHorizon = 2;
constexpr int kLevels = 2;                                    // level 0 1
const std::vector<std::string> kThings = {"Hammer", "Rock"};  // only the hammer is a tool

/// One instance: values of `level`, `thing` and `time`.
struct Values {
  int level = 0;
  std::size_t thing = 0;
  int time = 0;
};

/// A part of the formula with its reading: its text over variables, its text in an instance, and
/// whether the atoms that it names exist there.
struct Part {
  enum class Kind { kInitiates, kTerminates, kHolds, kHappens } kind = Kind::kHolds;
  int what = 0;   // 0: a level fluent, 1: a tool fluent, 2: the fluent without arguments
  int level = 0;  // offset of the level
  int time = 0;   // offset of the timepoint

  static std::string plus(const std::string& name, int offset) {
    if (offset == 0) return name;
    return name + (offset > 0 ? "+" : "-") + std::to_string(std::abs(offset));
  }
  std::string print(const std::string& level_text, const std::string& thing,
                    const std::string& time_text) const {
    const std::string fluent = what == 0   ? "At(" + level_text + ")"
                               : what == 1 ? "Held(" + thing + ")"
                                           : std::string("Lit()");
    if (kind == Kind::kHolds) return "HoldsAt(" + fluent + "," + time_text + ")";
    if (kind == Kind::kHappens) return "Happens(Ring(" + level_text + ")," + time_text + ")";
    return std::string(kind == Kind::kInitiates ? "Initiates" : "Terminates") + "(Push()," +
           fluent + "," + time_text + ")";
  }
  std::string open() const { return print(plus("level", level), "thing", plus("time", time)); }
  std::string in(const Values& values) const {
    return print(std::to_string(values.level + level), kThings[values.thing],
                 std::to_string(values.time + time));
  }
  bool exists(const Values& values) const {
    const int t = values.time + time, l = values.level + level;
    const int last = kind == Kind::kHolds ? kHorizon : kHorizon - 1;
    if (t < 0 || t > last) return false;
    if (what == 0 || kind == Kind::kHappens) return l >= 0 && l < kLevels;
    return what != 1 || values.thing == 0;
  }
  bool is_effect() const { return kind == Kind::kInitiates || kind == Kind::kTerminates; }
};

struct Formula {
  Part condition;
  std::vector<Part> parts;

  static Part random_part(FuzzRandom& random, bool effect) {
    Part part;
    const auto roll = random.below(3);
    part.kind = effect      ? (roll < 2 ? Part::Kind::kInitiates : Part::Kind::kTerminates)
                : roll == 0 ? Part::Kind::kHappens
                            : Part::Kind::kHolds;
    part.what = static_cast<int>(random.below(3));
    if (random.chance(50)) part.level = random.chance(70) ? 1 : -1;
    if (!effect && random.chance(40)) part.time = random.chance(70) ? 1 : 2;
    return part;
  }
  static Formula random_formula(FuzzRandom& random) {
    Formula made;
    made.condition.what = static_cast<int>(random.below(2));
    made.parts = {random_part(random, true), random_part(random, random.chance(70))};
    if (random.chance(30)) made.parts.push_back(random_part(random, random.chance(50)));
    if (random.chance(50)) std::swap(made.parts[0], made.parts[1]);
    return made;
  }

  std::string open() const {
    std::string text = "[level,thing,time] " + condition.open() + " -> ";
    for (std::size_t i = 0; i < parts.size(); ++i) text += (i > 0 ? " & " : "") + parts[i].open();
    return text + ".\n";
  }
  /// Each conjunct of each instance in which everything exists.
  std::string written_out() const {
    std::string text;
    for (int level = 0; level < kLevels; ++level) {
      for (std::size_t thing = 0; thing < kThings.size(); ++thing) {
        for (int time = 0; time <= kHorizon; ++time) {
          const Values values{level, thing, time};
          const bool all = condition.exists(values) &&
                           std::all_of(parts.begin(), parts.end(),
                                       [&](const Part& part) { return part.exists(values); });
          for (const auto& part : parts) {
            if (all) text += condition.in(values) + " -> " + part.in(values) + ".\n";
          }
        }
      }
    }
    return text;
  }
  bool has_missing() const {
    for (int level = 0; level < kLevels; ++level) {
      for (std::size_t thing = 0; thing < kThings.size(); ++thing) {
        for (int time = 0; time < kHorizon; ++time) {
          const Values values{level, thing, time};
          const auto count = std::count_if(parts.begin(), parts.end(),
                                           [&](const Part& part) { return part.exists(values); });
          if (condition.exists(values) && count > 0 && count < std::ssize(parts)) return true;
        }
      }
    }
    return false;
  }
};

std::string declarations(FuzzRandom& random) {
  std::string text =
      "range time 0 2\nsort level: integer\nrange level 0 1\nsort thing\nsort tool: thing\n"
      "thing Rock\ntool Hammer\nfluent At(level)\nfluent Held(tool)\nfluent Lit()\n"
      "event Push()\nevent Ring(level)\n";
  for (const auto* fluent : {"At(0)", "At(1)", "Held(Hammer)", "Lit()"}) {
    if (random.chance(50))
      text += std::string(random.chance(50) ? "!" : "") + "HoldsAt(" + fluent + ",0).\n";
  }
  if (random.chance(50)) text += "Happens(Push(),0).\n";
  return text;
}

std::set<std::string> traces_of(const compiler::CompiledModel& model, bool& complete) {
  const auto list = enumerated_traces(model, 5000);
  complete = list.complete;
  std::set<std::string> keys;
  for (const auto& trace : list.traces) keys.insert(trace_key(trace, false));
  return keys;
}

TEST_CASE("an instance of a conjunction says all or nothing") {
  int compared = 0, missing = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    FuzzRandom random(seed);
    const auto start = declarations(random);
    const auto formula = Formula::random_formula(random);
    const auto text = start + formula.open();
    CAPTURE(text);
    const FuzzCompilation open(text, {}), written(start + formula.written_out(), {});
    REQUIRE(open.typed);
    REQUIRE(written.typed);
    if (!open.compiled || !written.compiled) {
      // A part of which no instance exists is refused; written out it is not there at all.
      const auto codes = open.codes();
      CHECK((codes == "E3003" || codes == "E3004"));
      continue;
    }
    bool all = false, all_written = false;
    const auto ours = traces_of(*open.compiled, all);
    const auto theirs = traces_of(*written.compiled, all_written);
    CHECK(all == all_written);
    if (all) CHECK(ours == theirs);
    ++compared;
    missing += formula.has_missing() ? 1 : 0;
  }
  CHECK(compared > 120);
  CHECK(missing > 50);
}

TEST_CASE("evaluator and logic program read conjunctions in the same way") {
  DifferentialOptions options;
  options.clingo = clingo_is_installed();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    FuzzRandom random(seed);
    const auto start = declarations(random);
    const auto text = start + Formula::random_formula(random).open();
    CAPTURE(text);
    const auto result = compare_oracles(text, options);
    CAPTURE(result.detail);
    CHECK(result.kind != Comparison::Kind::kDiffer);
  }
}

TEST_CASE("what is lost with a missing part is told, with its place") {
  const std::string start =
      "range time 0 1\nsort k: integer\nrange k 0 2\nfluent K(k)\nfluent L()\nevent E()\n";
  const auto warned = [](const FuzzCompilation& made) {
    std::string found;
    for (const auto& one : made.sink.sorted()) {
      if (base::info(one.code).id != "W3004") continue;
      found +=
          std::string(made.files.text(*one.range)) + one.message.substr(one.message.rfind(','));
      found += " | " + std::string(made.files.text(*one.notes.front().range)) + "\n";
    }
    return found;
  };
  const FuzzCompilation lost(
      start +
          "[k,time] HoldsAt(K(k),time) -> Initiates(E(),K(k+1),time) & Initiates(E(),L(),time).\n",
      {});
  CHECK(warned(lost) == "Initiates(E(),K(k+1),time), time=0 | Initiates(E(),L(),time)\n");
  const FuzzCompilation guarded(start +
                                    "[k,time] HoldsAt(K(k),time) & k<2 -> "
                                    "Initiates(E(),K(k+1),time) & Initiates(E(),L(),time).\n",
                                {});
  CHECK(warned(guarded).empty());
  const FuzzCompilation plain(
      start +
          "[k,time] HoldsAt(K(k),time) -> Initiates(E(),K(k),time) & Initiates(E(),L(),time).\n",
      {});
  CHECK(warned(plain).empty());
  CHECK(plain.typed->shared_instances.empty());
}

}  // namespace
}  // namespace parallax::test
