#include <algorithm>
#include <utility>

#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {
namespace {

class LimitedSolver final : public SatSolver {
 public:
  LimitedSolver(std::unique_ptr<SatSolver> solver, std::int64_t conflicts)
      : solver_(std::move(solver)), most_(conflicts) {}

  void add_clause(std::span<const Literal> clause) override { solver_->add_clause(clause); }
  void assume(Literal literal) override { solver_->assume(literal); }
  SolveStatus solve() override {
    const auto left = std::max<std::int64_t>(most_ - solver_->conflicts(), 0);
    solver_->limit_conflicts(std::min(left, std::exchange(next_, most_)));
    return solver_->solve();
  }
  bool value(Literal literal) const override { return solver_->value(literal); }
  bool failed(Literal literal) const override { return solver_->failed(literal); }
  bool is_fixed(Literal literal) const override { return solver_->is_fixed(literal); }
  void set_phase(Literal literal) override { solver_->set_phase(literal); }
  void limit_conflicts(std::int64_t most) override { next_ = most; }
  std::int64_t conflicts() const override { return solver_->conflicts(); }
  std::int64_t solve_calls() const override { return solver_->solve_calls(); }

 private:
  std::unique_ptr<SatSolver> solver_;
  std::int64_t most_;          // of all calls together
  std::int64_t next_ = most_;  // of the next one
};

}  // namespace

std::unique_ptr<SatSolver> make_limited_solver(std::unique_ptr<SatSolver> solver,
                                               std::int64_t conflicts) {
  return std::make_unique<LimitedSolver>(std::move(solver), conflicts);
}

}  // namespace parallax::runtime
