#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <set>

#include "runtime/explain/contradiction.h"
#include "tests/runtime/explain/plain_model.h"
#include "tests/support/random_model.h"

namespace parallax::test {
namespace {

using runtime::IndexSet;
using runtime::Literal;

/// Every subset is asked about; `contradicts` takes a bit mask.
std::vector<IndexSet> brute_force(std::size_t count,
                                  const std::function<bool(std::uint32_t)>& contradicts) {
  std::vector<bool> bad(std::size_t{1} << count);
  std::vector<IndexSet> minimal;
  for (std::uint32_t mask = 0; mask < bad.size(); ++mask) {
    bad[mask] = contradicts(mask);
    if (!bad[mask]) continue;
    IndexSet set;
    bool is_minimal = true;
    for (std::uint32_t i = 0; i < count; ++i) {
      if ((mask >> i & 1U) == 0) continue;
      set.push_back(i);
      is_minimal = is_minimal && !bad[mask & ~(1U << i)];
    }
    if (is_minimal) minimal.push_back(set);
  }
  std::sort(minimal.begin(), minimal.end(), [](const IndexSet& a, const IndexSet& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  return minimal;
}

constexpr int kVariables = 5;

/// Groups of random clauses over five variables.
struct RandomGroups {
  std::vector<std::vector<std::vector<int>>> groups;

  explicit RandomGroups(std::mt19937& random) {
    groups.resize(3 + random() % 7);
    for (auto& group : groups) {
      group.resize(1 + random() % 3);
      for (auto& clause : group) {
        clause.resize(1 + random() % 3);
        for (auto& literal : clause) {
          literal = 1 + static_cast<int>(random() % kVariables);
          if (random() % 2 == 0) literal = -literal;
        }
      }
    }
  }
  bool contradicts(std::uint32_t mask) const {
    for (std::uint32_t values = 0; values < 1U << kVariables; ++values) {
      if (satisfied(mask, values)) return false;
    }
    return true;
  }
  bool satisfied(std::uint32_t mask, std::uint32_t values) const {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if ((mask >> g & 1U) == 0) continue;
      for (const auto& clause : groups[g]) {
        const bool holds = std::any_of(clause.begin(), clause.end(), [&](int literal) {
          return ((values >> (std::abs(literal) - 1) & 1U) != 0) == (literal > 0);
        });
        if (!holds) return false;
      }
    }
    return true;
  }
  runtime::GroupSolver solver() const {
    runtime::GroupSolver solver(kVariables, groups.size(), runtime::make_cadical_solver());
    for (std::uint32_t g = 0; g < groups.size(); ++g) {
      for (const auto& clause : groups[g]) {
        std::vector<Literal> literals;
        for (const auto literal : clause) literals.push_back(Literal::from_dimacs(literal));
        solver.add(literals, g);
      }
    }
    return solver;
  }
};

TEST_CASE("all minimal sets, and a smallest one, are those of brute force") {
  std::mt19937 random(5);
  int contradictory = 0, several = 0;
  for (int i = 0; i < 400; ++i) {
    const RandomGroups groups(random);
    const auto expected = brute_force(groups.groups.size(),
                                      [&](std::uint32_t mask) { return groups.contradicts(mask); });
    auto solver = groups.solver();
    const auto all = runtime::all_minimal_sets(solver, 0, nullptr);
    CHECK(all.proven);
    CHECK(all.sets == expected);
    auto fresh = groups.solver();
    const auto smallest = runtime::smallest_set(fresh, nullptr);
    CHECK(smallest.proven);
    REQUIRE(smallest.sets.empty() == expected.empty());
    if (expected.empty()) continue;
    ++contradictory;
    several += expected.size() > 1 ? 1 : 0;
    CHECK(smallest.sets.front().size() == expected.front().size());
    CHECK(std::count(expected.begin(), expected.end(), smallest.sets.front()) == 1);
    auto limited_solver = groups.solver();
    const auto limited = runtime::all_minimal_sets(limited_solver, 1, nullptr);
    CHECK(limited.sets.size() == 1);
    CHECK(limited.proven == (expected.size() == 1));
  }
  CHECK(contradictory > 100);
  CHECK(several > 50);
}

TEST_CASE("a search that is stopped says that it does not know") {
  std::mt19937 random(5);
  const RandomGroups groups(random);
  const std::atomic<bool> stop{true};
  runtime::GroupSolver solver(kVariables, groups.groups.size(),
                              runtime::make_cadical_solver(&stop));
  CHECK(runtime::smallest_set(solver, &stop).unknown);
  CHECK_FALSE(runtime::smallest_set(solver, &stop).proven);
  CHECK_FALSE(runtime::all_minimal_sets(solver, 0, &stop).proven);
  CHECK(runtime::all_minimal_sets(solver, 0, &stop).unknown);
}

bool has_model(const compiler::CompiledModel& model, const runtime::AxiomGroups& groups,
               std::uint32_t mask) {
  const auto solver = runtime::make_cadical_solver();
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    const auto group = groups.group_of[model.clause_origins[i]];
    if (model.clause_is_definition[i] || (mask >> group & 1U) != 0) {
      solver->add_clause(model.clauses[i]);
    }
  }
  return solver->solve() == runtime::SolveStatus::kSatisfiable;
}

TEST_CASE("the minimal sets of random models are those of all subsets of their axioms") {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 1'500 && compared < 60; ++seed) {
    PlainModel model(random_model(seed, kSolverSize).print());
    if (model.sink.has_errors()) continue;
    const auto groups = runtime::group_axioms(model.compiled);
    if (groups.size() > 11 || has_model(model.compiled, groups, UINT32_MAX)) continue;
    ++compared;
    CAPTURE(seed);
    const auto expected = brute_force(groups.size(), [&](std::uint32_t mask) {
      return !has_model(model.compiled, groups, mask);
    });
    runtime::ExecutionFormula formula(model.compiled);
    auto solver = runtime::load_axioms(formula, groups, runtime::make_cadical_solver());
    CHECK(runtime::all_minimal_sets(solver, 0, nullptr).sets == expected);
    auto fresh = runtime::load_axioms(formula, groups, runtime::make_cadical_solver());
    const auto smallest = runtime::smallest_set(fresh, nullptr);
    REQUIRE(smallest.sets.size() == 1);
    CHECK(smallest.sets.front().size() == expected.front().size());
  }
  CHECK(compared > 20);
}

TEST_CASE("the ground instances of a set contradict each other, and no one can go") {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 800 && compared < 40; ++seed) {
    PlainModel model(random_model(seed, kSolverSize).print());
    if (model.sink.has_errors()) continue;
    const auto groups = runtime::group_axioms(model.compiled);
    runtime::ExecutionFormula formula(model.compiled);
    auto solver = runtime::load_axioms(formula, groups, runtime::make_cadical_solver());
    const auto found = runtime::smallest_set(solver, nullptr);
    if (found.sets.empty()) continue;
    ++compared;
    runtime::Effort enough(1'000'000), none(0);
    const auto ground =
        runtime::ground_contradiction(formula, groups, found.sets.front(), {}, enough);
    const auto cut = runtime::ground_contradiction(formula, groups, found.sets.front(), {}, none);
    CHECK_FALSE(cut.minimal);
    CHECK(cut.clauses.size() >= ground.clauses.size());
    CHECK(cut.proof.verdict == runtime::ProofVerdict::kAccepted);
    CHECK(ground.minimal);
    CHECK(ground.proof.verdict == runtime::ProofVerdict::kAccepted);
    for (std::size_t left_out = 0; left_out <= ground.clauses.size(); ++left_out) {
      const auto fresh = runtime::make_cadical_solver();
      formula.for_each_always([&](std::span<const Literal> clause) { fresh->add_clause(clause); });
      for (std::size_t i = 0; i < ground.clauses.size(); ++i) {
        if (i != left_out) fresh->add_clause(formula.clause(ground.clauses[i]));
      }
      CHECK((fresh->solve() == runtime::SolveStatus::kSatisfiable) ==
            (left_out < ground.clauses.size()));
    }
  }
  CHECK(compared > 20);
}

/// `F1 & !F2 -> F3`, say, about timepoint 0.
std::string random_axiom(std::mt19937& random) {
  const auto atom = [&] {
    return std::string(random() % 2 == 0 ? "!" : "") + "HoldsAt(F" + std::to_string(random() % 4) +
           "(),0)";
  };
  switch (random() % 4) {
    case 0:
      return atom();
    case 1:
      return atom() + " | " + atom();
    case 2:
      return atom() + " <-> " + atom();
    default:
      return atom() + " & " + atom() + " -> " + atom();
  }
}

TEST_CASE(
    "the lines named are those without which the text has a model, found by leaving lines out") {
  std::mt19937 random(17);
  int contradictory = 0;
  for (int i = 0; i < 60; ++i) {
    std::vector<std::string> lines(7);
    for (auto& line : lines) line = random_axiom(random);
    const auto text = [&](std::uint32_t mask) {
      std::string out = "range time 0 0\nfluent F0()\nfluent F1()\nfluent F2()\nfluent F3()\n";
      for (std::size_t k = 0; k < lines.size(); ++k) {
        out += (mask >> k & 1U) != 0 ? lines[k] + ".\n" : "\n";
      }
      return out;
    };
    const PlainModel whole(text(UINT32_MAX));
    if (whole.sink.has_errors()) continue;  // a line that is false whatever holds
    const auto expected = brute_force(lines.size(), [&](std::uint32_t mask) {
      const PlainModel part(text(mask));
      REQUIRE_FALSE(part.sink.has_errors());
      return !has_model(part.compiled, runtime::group_axioms(part.compiled), UINT32_MAX);
    });
    contradictory += expected.empty() ? 0 : 1;
    const auto groups = runtime::group_axioms(whole.compiled);
    runtime::ExecutionFormula formula(whole.compiled);
    auto solver = runtime::load_axioms(formula, groups, runtime::make_cadical_solver());
    std::vector<IndexSet> named;
    for (const auto& set : runtime::all_minimal_sets(solver, 0, nullptr).sets) {
      auto& found = named.emplace_back();
      for (const auto group : set) {
        const auto source = whole.compiled.origins[groups.origins[group].front()].source;
        found.push_back(whole.files[source.file].position(source.begin).line - 6);
      }
    }
    CHECK(named == expected);
  }
  CHECK(contradictory > 10);
}

}  // namespace
}  // namespace parallax::test
