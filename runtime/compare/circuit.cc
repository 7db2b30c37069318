#include "runtime/compare/circuit.h"

#include <algorithm>
#include <utility>

namespace parallax::runtime {

Circuit::Circuit(SatSolver& solver, std::int32_t first_free)
    : solver_(&solver), next_(first_free), truth_(Literal::positive(next_++)) {
  solver_->add_clause(std::span(&truth_, 1));
}

Circuit::Clause Circuit::simplified(std::vector<Literal> literals) const {
  std::sort(literals.begin(), literals.end(), [](Literal a, Literal b) {
    return std::pair(a.var(), a.dimacs()) < std::pair(b.var(), b.dimacs());
  });
  std::size_t kept = 0;
  for (const auto literal : literals) {
    if (literal == ~truth_) continue;
    const bool opposite = kept > 0 && literals[kept - 1] == ~literal;
    if (literal == truth_ || opposite) return {{}, true};
    if (kept == 0 || literals[kept - 1] != literal) literals[kept++] = literal;
  }
  literals.resize(kept, truth_);
  return {std::move(literals), false};
}

Literal Circuit::conjunction(std::vector<Literal> literals) {
  for (auto& literal : literals) literal = ~literal;
  return ~disjunction(std::move(literals));
}

Literal Circuit::disjunction(std::vector<Literal> literals) {
  auto clause = simplified(std::move(literals));
  if (clause.satisfied) return truth_;
  if (clause.literals.empty()) return ~truth_;
  if (clause.literals.size() == 1) return clause.literals.front();
  if (const auto known = gates_.find(clause.literals)) return *known;
  const auto gate = new_variable();
  gates_.emplace(clause.literals, gate);
  for (const auto literal : clause.literals) {
    const Literal implies[] = {gate, ~literal};
    solver_->add_clause(implies);
  }
  clause.literals.push_back(~gate);
  solver_->add_clause(clause.literals);
  return gate;
}

EventCounter::EventCounter(Circuit& circuit, SatSolver& solver,
                           const std::vector<Literal>& literals, std::size_t bound)
    : reached_(bound, circuit.constant(false)) {
  for (const auto literal : literals) {
    auto next = reached_;
    for (std::size_t j = 0; j < bound; ++j) {
      // Nothing before: as many as so far cannot be reached.
      const bool possible = j == 0 || reached_[j - 1] != circuit.constant(false);
      if (!possible) break;
      next[j] = circuit.new_variable();
      const Literal kept[] = {~reached_[j], next[j]};
      solver.add_clause(kept);
      std::vector<Literal> counted = {~literal, next[j]};
      if (j > 0) counted.push_back(~reached_[j - 1]);
      solver.add_clause(counted);
    }
    reached_ = std::move(next);
  }
}

}  // namespace parallax::runtime
