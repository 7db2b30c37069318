#include "runtime/explain/hitting_set.h"

namespace parallax::runtime {

HittingSets::HittingSets(std::size_t count, std::size_t bound, const std::atomic<bool>* stop)
    : solver_(make_cadical_solver(stop)), count_(count), bound_(bound) {
  for (std::size_t i = 0; i < count; ++i) {
    solver_->set_phase(~element(i));
    const Literal one[] = {~element(i), at_least(1, i)};
    solver_->add_clause(one);
    for (std::size_t j = 1; i > 0 && j <= bound + 1; ++j) {
      const Literal kept[] = {~at_least(j, i - 1), at_least(j, i)};
      solver_->add_clause(kept);
      if (j == 1) continue;
      const Literal more[] = {~element(i), ~at_least(j - 1, i - 1), at_least(j, i)};
      solver_->add_clause(more);
    }
  }
}

Literal HittingSets::at_least(std::size_t j, std::size_t i) const {
  return Literal::positive(static_cast<std::int32_t>(count_ + i * (bound_ + 1) + j));
}

void HittingSets::add(const IndexSet& to_hit) {
  std::vector<Literal> clause;
  for (const auto i : to_hit) clause.push_back(element(i));
  solver_->add_clause(clause);
}

std::optional<IndexSet> HittingSets::smallest() {
  for (; size_ <= bound_; ++size_) {
    if (count_ > 0) solver_->assume(~at_least(size_ + 1, count_ - 1));
    const auto status = solver_->solve();
    stopped_ = status == SolveStatus::kUnknown;
    if (stopped_) return std::nullopt;
    if (status == SolveStatus::kUnsatisfiable) continue;
    IndexSet set;
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (solver_->value(element(i))) set.push_back(i);
    }
    return set;
  }
  return std::nullopt;
}

}  // namespace parallax::runtime
