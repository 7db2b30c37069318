#include "runtime/certify/logged_solver.h"

#include <algorithm>
#include <vector>

namespace parallax::runtime {
namespace {

class LoggedSolver final : public SatSolver {
 public:
  LoggedSolver(std::FILE* proof, const CompletenessClaim& claim, const std::atomic<bool>* stop)
      : proof_(proof),
        claim_variables_(claim.variables()),
        solver_(make_proving_solver(proof, ProofForm::kBinary, stop, ProofUse::kIncremental)) {
    for (const auto literal : claim.given()) log(std::span(&literal, 1));
  }

  void add_clause(std::span<const Literal> clause) override {
    if (solver_->solve_calls() > 0) log_addition(clause);
    solver_->add_clause(clause);
  }
  void assume(Literal literal) override {
    assumed_.push_back(literal);
    solver_->assume(literal);
  }
  SolveStatus solve() override {
    const auto status = solver_->solve();
    if (status == SolveStatus::kUnsatisfiable) log_core();
    assumed_.clear();
    return status;
  }
  bool value(Literal literal) const override { return solver_->value(literal); }
  bool failed(Literal literal) const override { return solver_->failed(literal); }
  bool is_fixed(Literal literal) const override { return solver_->is_fixed(literal); }
  void set_phase(Literal literal) override { solver_->set_phase(literal); }
  void limit_conflicts(std::int64_t most) override { solver_->limit_conflicts(most); }
  std::int64_t conflicts() const override { return solver_->conflicts(); }
  std::int64_t solve_calls() const override { return solver_->solve_calls(); }

 private:
  void log_addition(std::span<const Literal> clause) {
    if (clause.empty()) return;
    clause_.assign(clause.begin(), clause.end());
    const auto last = std::max_element(clause_.begin(), clause_.end(),
                                       [](Literal a, Literal b) { return a.var() < b.var(); });
    if (clause_.size() > 1 && last->var() <= claim_variables_) return;
    std::iter_swap(clause_.begin(), last);
    log(clause_);
  }
  void log_core() {
    clause_.clear();
    for (const auto literal : assumed_) {
      if (solver_->failed(literal)) clause_.push_back(~literal);
    }
    log(clause_);
  }
  /// Binary DRAT: `a`, each literal as 2v or 2v + 1 in groups of 7 bits, 0.
  void log(std::span<const Literal> clause) {
    std::fputc('a', proof_);
    for (const auto literal : clause) {
      auto code =
          2U * static_cast<std::uint32_t>(literal.var()) + (literal.is_positive() ? 0U : 1U);
      for (; code > 127; code >>= 7U) std::fputc(static_cast<int>((code & 127U) | 128U), proof_);
      std::fputc(static_cast<int>(code), proof_);
    }
    std::fputc(0, proof_);
  }

  std::FILE* proof_;
  std::int64_t claim_variables_;
  std::unique_ptr<SatSolver> solver_;
  std::vector<Literal> assumed_, clause_;
};

}  // namespace

std::unique_ptr<SatSolver> make_logged_solver(std::FILE* proof, const CompletenessClaim& claim,
                                              const std::atomic<bool>* stop) {
  return std::make_unique<LoggedSolver>(proof, claim, stop);
}

}  // namespace parallax::runtime
