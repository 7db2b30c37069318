#include "runtime/enumerate/clause_search.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "tests/support/clause_problem.h"

namespace parallax::test {
namespace {

using compiler::Literal;
using runtime::ClauseSearch;
using Status = ClauseSearch::Status;

constexpr auto kUnlimited = std::numeric_limits<std::int64_t>::max();

std::vector<Valuation> found(ClauseSearch& search, const ClauseProblem& problem,
                             std::int64_t budget) {
  std::vector<Valuation> out;
  search.begin(problem.assumptions);
  while (true) {
    const auto status = search.next(budget);
    if (status == Status::kNoMore) return out;
    if (status == Status::kGaveUp) continue;
    for (const auto& clause : problem.clauses) {
      CHECK(std::any_of(clause.begin(), clause.end(),
                        [&](Literal literal) { return search.value(literal); }));
    }
    auto& valuation = out.emplace_back();
    for (const auto literal : problem.projected) valuation.push_back(search.value(literal));
  }
}

ClauseSearch made(const ClauseProblem& problem) {
  ClauseSearch search(problem.variables, problem.projected);
  for (const auto& clause : problem.clauses) search.add_clause(clause);
  return search;
}

}  // namespace

TEST_CASE("the search finds what trying all valuations finds, each once and in order") {
  std::mt19937_64 random(7);
  std::size_t valuations = 0, empty = 0;
  for (int i = 0; i < 5000; ++i) {
    auto problem = random_clauses(random);
    auto search = made(problem);
    for (int again = 0; again < 2; ++again) {
      const auto wanted = by_brute_force(problem);
      CHECK(found(search, problem, kUnlimited) == std::vector(wanted.begin(), wanted.end()));
      // A search that was given up goes on where it was.
      CHECK(found(search, problem, 0) == std::vector(wanted.begin(), wanted.end()));
      valuations += wanted.size();
      empty += wanted.empty() ? 1 : 0;
      // The same object, from another state.
      problem.assumptions = {Literal::from_dimacs(again == 0 ? 1 : -1)};
    }
  }
  CHECK(valuations > 20'000);
  CHECK(empty > 500);
}

/// Three literals a clause and about four clauses a variable: where most choices lead nowhere.
TEST_CASE("what was learned and forgotten loses nothing and adds nothing") {
  std::mt19937_64 random(11);
  std::size_t valuations = 0;
  std::int64_t conflicts = 0;
  for (int i = 0; i < 300; ++i) {
    ClauseProblem problem;
    problem.variables = 16;
    const int clauses = std::uniform_int_distribution<int>(45, 68)(random);
    const auto literal = [&] {
      const auto v = std::uniform_int_distribution<int>(1, 16)(random);
      return Literal::from_dimacs(random() % 2 == 0 ? v : -v);
    };
    for (int c = 0; c < clauses; ++c) problem.clauses.push_back({literal(), literal(), literal()});
    const int told_apart = std::uniform_int_distribution<int>(4, 16)(random);
    for (int v = 1; v <= told_apart; ++v) problem.projected.push_back(Literal::positive(v));
    ClauseSearch search(problem.variables, problem.projected, 3);
    for (const auto& clause : problem.clauses) search.add_clause(clause);
    for (int again = 0; again < 4; ++again) {
      const auto wanted = by_brute_force(problem);
      CHECK(found(search, problem, kUnlimited) == std::vector(wanted.begin(), wanted.end()));
      valuations += wanted.size();
      problem.assumptions = {literal(), literal()};
    }
    conflicts += search.conflicts();
  }
  CHECK(valuations > 10'000);
  CHECK(conflicts > 3000);
}

TEST_CASE("a search gives up when its budget of conflicts is spent") {
  // Seven pigeons in six holes.
  ClauseProblem problem;
  const auto in = [](int pigeon, int hole) { return Literal::positive(pigeon * 6 + hole + 1); };
  problem.variables = 42;
  for (int p = 0; p < 7; ++p) {
    auto& clause = problem.clauses.emplace_back();
    for (int h = 0; h < 6; ++h) clause.push_back(in(p, h));
    for (int q = 0; q < p; ++q) {
      for (int h = 0; h < 6; ++h) problem.clauses.push_back({~in(p, h), ~in(q, h)});
    }
  }
  auto search = made(problem);
  search.begin({});
  CHECK(search.next(50) == Status::kGaveUp);
  CHECK(search.conflicts() == 51);
  CHECK(search.next(kUnlimited) == Status::kNoMore);
  CHECK(search.conflicts() > 51);
}

}  // namespace parallax::test
