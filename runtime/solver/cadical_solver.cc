#include <algorithm>
#include <cadical.hpp>
#include <climits>
#include <utility>

#include "runtime/solver/sharing_solver.h"

namespace parallax::runtime {
namespace {

class CadicalSolver final : public SharingSolver {
 public:
  explicit CadicalSolver(const std::atomic<bool>* stop) : terminator_(stop) {
    solver_.set("quiet", 1);
    solver_.connect_learner(&learned_);
    if (stop != nullptr) solver_.connect_terminator(&terminator_);
  }
  CadicalSolver(std::size_t longest, const std::atomic<bool>* stop) : CadicalSolver(stop) {
    learned_.longest = longest;
  }
  CadicalSolver(std::FILE* proof, ProofForm form, const std::atomic<bool>* stop, ProofUse use)
      : CadicalSolver(stop) {
    solver_.set("binary", form == ProofForm::kBinary ? 1 : 0);
    if (use == ProofUse::kIncremental) {
      solver_.set("elim", 0);
      solver_.set("decompose", 0);
    }
    solver_.trace_proof(proof, "proof");
  }

  void add_clause(std::span<const Literal> clause) override {
    for (const auto literal : clause) solver_.add(literal.dimacs());
    solver_.add(0);
    state_ = State::kReady;
  }
  void assume(Literal literal) override {
    solver_.assume(literal.dimacs());
    state_ = State::kReady;
  }
  SolveStatus solve() override {
    ++calls_;
    // Easy calls end before the solver looks at the flag, and there can be very many of them.
    if (terminator_.terminate()) return SolveStatus::kUnknown;
    switch (solver_.solve()) {
      case 10:
        state_ = State::kSatisfied;
        return SolveStatus::kSatisfiable;
      case 20:
        state_ = State::kFailed;
        return SolveStatus::kUnsatisfiable;
      default:
        state_ = State::kReady;
        return SolveStatus::kUnknown;
    }
  }
  bool value(Literal literal) const override {
    PARALLAX_REQUIRE(state_ == State::kSatisfied, "values are asked after a satisfiable call");
    // Only variables are queried: the sign of `val` for negative literals differs by version.
    const bool positive = solver_.val(literal.var()) > 0;
    return positive == literal.is_positive();
  }
  bool failed(Literal literal) const override {
    PARALLAX_REQUIRE(state_ == State::kFailed, "cores are asked after an unsatisfiable call");
    return solver_.failed(literal.dimacs());
  }
  bool is_fixed(Literal literal) const override {
    const int sign = solver_.fixed(literal.var());
    return literal.is_positive() ? sign > 0 : sign < 0;
  }
  void set_phase(Literal literal) override { solver_.phase(literal.dimacs()); }
  void limit_conflicts(std::int64_t most) override {
    solver_.limit("conflicts", static_cast<int>(std::min<std::int64_t>(most, INT_MAX)));
  }
  std::int64_t conflicts() const override { return learned_.clauses; }
  std::int64_t solve_calls() const override { return calls_; }
  std::vector<std::vector<Literal>> take_learned() override {
    return std::exchange(learned_.kept, {});
  }

 private:
  enum class State : std::uint8_t { kReady, kSatisfied, kFailed };
  class StopFlag final : public CaDiCaL::Terminator {
   public:
    explicit StopFlag(const std::atomic<bool>* stop) : stop_(stop) {}
    bool terminate() override { return stop_ != nullptr && stop_->load(std::memory_order_relaxed); }

   private:
    const std::atomic<bool>* stop_;
  };
  class LearnedClauses final : public CaDiCaL::Learner {
   public:
    bool learning(int size) override {
      ++clauses;
      return static_cast<std::size_t>(size) <= longest;  // others are of no interest
    }
    void learn(int literal) override {
      if (literal == 0) {
        kept.push_back(std::exchange(next_, {}));
      } else {
        const auto variable = Literal::positive(literal < 0 ? -literal : literal);
        next_.push_back(literal < 0 ? ~variable : variable);
      }
    }
    std::size_t longest = 0;
    std::vector<std::vector<Literal>> kept;
    std::int64_t clauses = 0;

   private:
    std::vector<Literal> next_;
  };
  StopFlag terminator_;
  LearnedClauses learned_;
  // CaDiCaL's queries are not const in 1.5.3.
  mutable CaDiCaL::Solver solver_;
  State state_ = State::kReady;
  std::int64_t calls_ = 0;
};

}  // namespace

std::unique_ptr<SatSolver> make_cadical_solver(const std::atomic<bool>* stop) {
  return std::make_unique<CadicalSolver>(stop);
}

std::unique_ptr<SharingSolver> make_sharing_solver(std::size_t longest,
                                                   const std::atomic<bool>* stop) {
  return std::make_unique<CadicalSolver>(longest, stop);
}

std::unique_ptr<SatSolver> make_proving_solver(std::FILE* proof, ProofForm form,
                                               const std::atomic<bool>* stop, ProofUse use) {
  return std::make_unique<CadicalSolver>(proof, form, stop, use);
}

}  // namespace parallax::runtime
