#include "runtime/enumerate/clause_search.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>

namespace parallax::test {
namespace {

using compiler::Literal;
using runtime::ClauseSearch;
using Status = ClauseSearch::Status;
using Clauses = std::vector<std::vector<Literal>>;
using Valuation = std::vector<bool>;

constexpr auto kUnlimited = std::numeric_limits<std::int64_t>::max();

struct Problem {
  std::int32_t variables = 0;
  Clauses clauses;
  std::vector<Literal> projected, assumptions;
};

Problem random_problem(std::mt19937_64& random) {
  const auto draw = [&](int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random);
  };
  Problem problem;
  problem.variables = draw(1, 10);
  const auto literal = [&] {
    const auto v = draw(1, problem.variables);
    return Literal::from_dimacs(draw(0, 1) == 0 ? v : -v);
  };
  for (int i = draw(0, 25); i > 0; --i) {
    auto& clause = problem.clauses.emplace_back();
    for (int k = draw(0, 40) == 0 ? 0 : draw(1, 4); k > 0; --k) clause.push_back(literal());
  }
  std::vector<std::int32_t> some;
  for (std::int32_t v = 1; v <= problem.variables; ++v) {
    if (draw(0, 2) != 0) some.push_back(v);
  }
  std::shuffle(some.begin(), some.end(), random);
  for (const auto v : some) problem.projected.push_back(Literal::positive(v));
  for (int i = draw(0, 2); i > 0; --i) problem.assumptions.push_back(literal());
  return problem;
}

/// Tries all valuations. In ascending order, false before true.
std::set<Valuation> by_brute_force(const Problem& problem) {
  std::set<Valuation> out;
  for (std::uint32_t bits = 0; bits < (1U << static_cast<unsigned>(problem.variables)); ++bits) {
    const auto holds = [&](Literal literal) {
      return ((bits >> static_cast<unsigned>(literal.var() - 1) & 1U) != 0) ==
             literal.is_positive();
    };
    bool is_model = true;
    for (const auto& clause : problem.clauses) {
      is_model = is_model && std::any_of(clause.begin(), clause.end(), holds);
    }
    for (const auto literal : problem.assumptions) is_model = is_model && holds(literal);
    if (!is_model) continue;
    Valuation valuation;
    for (const auto literal : problem.projected) valuation.push_back(holds(literal));
    out.insert(valuation);
  }
  return out;
}

std::vector<Valuation> found(ClauseSearch& search, const Problem& problem, std::int64_t budget) {
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

ClauseSearch made(const Problem& problem) {
  ClauseSearch search(problem.variables, problem.projected);
  for (const auto& clause : problem.clauses) search.add_clause(clause);
  return search;
}

}  // namespace

TEST_CASE("the search finds what trying all valuations finds, each once and in order") {
  std::mt19937_64 random(7);
  std::size_t valuations = 0, empty = 0;
  for (int i = 0; i < 5000; ++i) {
    auto problem = random_problem(random);
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

TEST_CASE("a search gives up when its budget of conflicts is spent") {
  // Seven pigeons in six holes.
  Problem problem;
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
