// Preferred traces, compared with what circumscription says of every assignment that the reference
// evaluator accepts.
#include "runtime/optimize/minimal_choice.h"

#include <algorithm>
#include <map>
#include <set>

#include "compiler/base/ground_name.h"
#include "runtime/graph/trace_count.h"
#include "tests/runtime/enumerate/brute_force.h"
#include "tests/support/deep.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using Sets = std::vector<std::set<std::string>>;  // by level

/// `Happens(E(),1)` of an assignment, for the atoms of these symbols.
std::set<std::string> true_of(const compiler::Valuation& valuation,
                              const std::set<std::string>& symbols) {
  std::set<std::string> out;
  const auto take = [&](const char* kind, const std::set<std::string>& names, std::size_t t) {
    for (const auto& name : names) {
      if (symbols.contains(base::symbol_of(name))) {
        out.insert(kind + ("(" + name) + "," + std::to_string(t) + ")");
      }
    }
  };
  for (std::size_t t = 0; t < valuation.holds.size(); ++t) {
    take("HoldsAt", valuation.holds[t], t);
    take("Happens", valuation.happens[t], t);
  }
  for (const auto& name : valuation.predicates) {
    if (symbols.contains(base::symbol_of(name))) out.insert(name);
  }
  return out;
}

/// Is one better than the other, the first level first?
bool is_better(const Sets& one, const Sets& other) {
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (one[i] == other[i]) continue;
    return std::includes(other[i].begin(), other[i].end(), one[i].begin(), one[i].end());
  }
  return false;
}

struct Expected {
  std::set<std::string> traces;
  std::set<Sets> choices;
};
Expected circumscribe(BruteForce& brute, const std::vector<std::set<std::string>>& levels) {
  std::map<Sets, std::set<std::string>> traces;
  brute.for_each([&](const auto& values) {
    const auto valuation = brute.valuation(values);
    Sets sets;
    for (const auto& level : levels) sets.push_back(true_of(valuation, level));
    traces[sets].insert(signature(valuation));
  });
  Expected out;
  for (const auto& [sets, with] : traces) {
    const bool beaten = std::any_of(traces.begin(), traces.end(), [&](const auto& other) {
      return is_better(other.first, sets);
    });
    if (beaten) continue;
    out.choices.insert(sets);
    out.traces.insert(with.begin(), with.end());
  }
  return out;
}

runtime::Levels literals(const compiler::CompiledModel& model,
                         const std::vector<std::set<std::string>>& levels) {
  using compiler::AtomKind;
  runtime::Levels out(levels.size());
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    const bool counts = atom.kind == AtomKind::kHoldsAt || atom.kind == AtomKind::kHappens ||
                        atom.kind == AtomKind::kPredicate;
    for (std::size_t i = 0; counts && i < levels.size(); ++i) {
      if (!levels[i].contains(base::symbol_of(atom.name))) continue;
      out[i].push_back(atom.literal());
      return;
    }
  });
  return out;
}

/// One or two levels of one or two symbols; a symbol counts in the first one that names it.
std::vector<std::set<std::string>> some_levels(const compiler::TypedModel& typed,
                                               FuzzRandom& random) {
  std::vector<std::string> names;
  for (const auto& symbol : typed.symbols) {
    // Predicates of the random models have short names, those of the foundations long ones.
    const bool counts = symbol.kind == compiler::SymbolKind::kFluent ||
                        symbol.kind == compiler::SymbolKind::kEvent ||
                        (symbol.kind == compiler::SymbolKind::kPredicate && symbol.name.size() < 3);
    if (counts) names.push_back(symbol.name);
  }
  std::vector<std::set<std::string>> levels(1 + random.below(2));
  std::set<std::string> taken;
  for (auto& level : levels) {
    for (std::size_t i = 0; i < 1 + random.below(2) && !names.empty(); ++i) {
      const auto& name = random.pick(names);
      if (taken.insert(name).second) level.insert(name);
    }
  }
  return levels;
}

/// The text, and that one of two atoms of the first level is true, which leaves a choice.
std::string with_choice(const std::string& text, const compiler::CompiledModel& compiled,
                        const std::set<std::string>& level, FuzzRandom& random) {
  const auto is_wanted = [&](const std::string& atom) {
    return level.contains(atom.substr(0, atom.find('(')));
  };
  std::vector<std::string> atoms;
  for (const auto& fluent : compiled.fluents) {
    if (is_wanted(fluent.name)) atoms.push_back("HoldsAt(" + fluent.name + ",0)");
  }
  for (const auto& event : compiled.events) {
    if (is_wanted(event.name)) atoms.push_back("Happens(" + event.name + ",0)");
  }
  if (atoms.size() < 2) return text;
  return text + random.pick(atoms) + " | " + random.pick(atoms) + ".\n";
}

TEST_CASE("preferred traces are those of minimal sets, whatever the model") {
  const std::uint64_t seeds = is_deep() ? 5'000 : 400;
  int compared = 0, with_several = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const auto plain = random_model(seed, kBruteForceSize).print();
    const TextModel first(plain);
    if (!first.ground) continue;
    FuzzRandom random(seed);
    const auto levels = some_levels(*first.typed, random);
    // Most random models have one minimal set, so every other one gets a choice.
    const auto text =
        seed % 2 == 0 ? plain : with_choice(plain, first.compiled, levels.front(), random);
    const TextModel model(text);
    if (!model.ground) continue;
    BruteForce brute(*model.typed);
    if (brute.open_atoms() > 14) continue;
    CAPTURE(text);
    const auto expected = circumscribe(brute, levels);
    const auto wanted = literals(model.compiled, levels);
    runtime::SolverSession session(model.compiled, runtime::make_cadical_solver(),
                                   runtime::Loading::kWitness);
    const auto found = runtime::minimal_choices(session, wanted, 100'000);
    REQUIRE(found.complete);
    CHECK(found.choices.size() == expected.choices.size());
    ++compared;
    if (found.choices.empty()) continue;
    if (found.choices.size() > 1) ++with_several;
    const auto preferred = runtime::with_choices(model.compiled, wanted, found.choices);
    std::set<std::string> traces;
    for (const auto& trace : enumerate_all(*model.typed, preferred)) {
      CHECK_MESSAGE(traces.insert(trace).second, "twice: " << trace);
    }
    CHECK(traces == expected.traces);
  }
  MESSAGE(compared << " models, " << with_several << " with several minimal sets");
  CHECK(compared > static_cast<int>(seeds / 2));
  CHECK(with_several * 50 > compared);
}

TEST_CASE("more minimal sets than asked for are no answer") {
  const TextModel model("range time 0 1\nsort a\na A, B, C\nfluent F(a)\n{a} HoldsAt(F(a),0).\n");
  const auto wanted = literals(model.compiled, {{"F"}});
  const auto ask = [&](std::size_t most) {
    runtime::SolverSession session(model.compiled, runtime::make_cadical_solver(),
                                   runtime::Loading::kWitness);
    return runtime::minimal_choices(session, wanted, most);
  };
  CHECK(ask(3).complete);
  CHECK(ask(3).choices.size() == 3);
  CHECK_FALSE(ask(2).complete);
}

}  // namespace
}  // namespace parallax::test
