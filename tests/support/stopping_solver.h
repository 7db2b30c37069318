#pragma once

#include <atomic>
#include <memory>

#include "runtime/solver/sat_solver.h"

namespace parallax::test {

/// Says when a search is to be stopped: at the solver call with this number, counted over all
/// solvers that share it, and from then on. The flag is raised with it, for other code that looks
/// at it.
struct StopAt {
  std::int64_t call = 0;
  std::int64_t calls = 0;
  std::atomic<bool> flag{false};
  explicit StopAt(std::int64_t n) : call(n), flag(n == 0) {}
  bool is_reached() const { return flag.load(); }
};

/// CaDiCaL until then.
class StoppingSolver final : public runtime::SatSolver {
 public:
  explicit StoppingSolver(StopAt& stop) : stop_(stop) {}
  void add_clause(std::span<const runtime::Literal> clause) override { inner_->add_clause(clause); }
  void assume(runtime::Literal literal) override { inner_->assume(literal); }
  runtime::SolveStatus solve() override {
    if (stop_.calls++ >= stop_.call) stop_.flag = true;
    return inner_->solve();
  }
  bool value(runtime::Literal literal) const override { return inner_->value(literal); }
  bool failed(runtime::Literal literal) const override { return inner_->failed(literal); }
  bool is_fixed(runtime::Literal literal) const override { return inner_->is_fixed(literal); }
  void set_phase(runtime::Literal literal) override { inner_->set_phase(literal); }
  void limit_conflicts(std::int64_t most) override { inner_->limit_conflicts(most); }
  std::int64_t conflicts() const override { return inner_->conflicts(); }
  std::int64_t solve_calls() const override { return inner_->solve_calls(); }

 private:
  StopAt& stop_;
  std::unique_ptr<runtime::SatSolver> inner_ = runtime::make_cadical_solver(&stop_.flag);
};

/// Calls `question` with a search that is stopped at its first solver call, at its second, and so
/// on, until one is not stopped any more; `question` compares the answer that it gets with the full
/// one.
template <typename Question>
std::int64_t sweep_stops(const Question& question) {
  for (std::int64_t n = 0;; ++n) {
    StopAt stop(n);
    question(stop);
    if (!stop.is_reached()) return n;
  }
}

}  // namespace parallax::test
