#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include "compiler/artifact/literal.h"

namespace parallax::test {

using Valuation = std::vector<bool>;

/// Clauses, the literals that distinguish valuations, and assumptions.
struct ClauseProblem {
  std::int32_t variables = 0;
  std::vector<std::vector<compiler::Literal>> clauses;
  std::vector<compiler::Literal> projected, assumptions;
};

inline ClauseProblem random_clauses(std::mt19937_64& random) {
  const auto draw = [&](int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random);
  };
  ClauseProblem problem;
  problem.variables = draw(1, 10);
  const auto literal = [&] {
    const auto v = draw(1, problem.variables);
    return compiler::Literal::from_dimacs(draw(0, 1) == 0 ? v : -v);
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
  for (const auto v : some) problem.projected.push_back(compiler::Literal::positive(v));
  for (int i = draw(0, 2); i > 0; --i) problem.assumptions.push_back(literal());
  return problem;
}

/// Tries all valuations. In ascending order, false before true.
inline std::set<Valuation> by_brute_force(const ClauseProblem& problem) {
  std::set<Valuation> out;
  for (std::uint32_t bits = 0; bits < (1U << static_cast<unsigned>(problem.variables)); ++bits) {
    const auto holds = [&](compiler::Literal literal) {
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

}  // namespace parallax::test
