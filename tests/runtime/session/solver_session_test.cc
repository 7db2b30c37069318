#include "runtime/session/solver_session.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runtime/enumerate/plan_enumerator.h"
#include "tests/support/planned_model.h"

namespace parallax::test {
namespace {

using compiler::Literal;
using runtime::SolveStatus;

/// Counts of the work given to a solver; outlives the solver.
struct Ledger {
  std::int64_t clauses = 0;
  std::int64_t calls = 0;
  std::int32_t highest_variable = 0;
};

/// Hands everything on to CaDiCaL and keeps the ledger.
class CountingSolver final : public runtime::SatSolver {
 public:
  explicit CountingSolver(Ledger& ledger) : ledger_(ledger) {}
  void add_clause(std::span<const Literal> clause) override {
    ++ledger_.clauses;
    for (const auto literal : clause) note(literal);
    inner_->add_clause(clause);
  }
  void assume(Literal literal) override {
    note(literal);
    inner_->assume(literal);
  }
  SolveStatus solve() override {
    ++ledger_.calls;
    return inner_->solve();
  }
  bool value(Literal literal) const override { return inner_->value(literal); }
  bool failed(Literal literal) const override { return inner_->failed(literal); }
  bool is_fixed(Literal literal) const override { return inner_->is_fixed(literal); }
  void set_phase(Literal literal) override { inner_->set_phase(literal); }
  void limit_conflicts(std::int64_t most) override { inner_->limit_conflicts(most); }
  std::int64_t conflicts() const override { return inner_->conflicts(); }
  std::int64_t solve_calls() const override { return ledger_.calls; }

 private:
  void note(Literal literal) {
    ledger_.highest_variable = std::max(ledger_.highest_variable, literal.var());
  }
  Ledger& ledger_;
  std::unique_ptr<runtime::SatSolver> inner_ = runtime::make_cadical_solver();
};

/// A robot that drives to and fro.
const std::string kModel = kTwoRooms + "HoldsAt(At(a1),0).\n";
constexpr const char* kBinding = R"(
motion going (:target ?p) -> Go(region(?p))  ok: At(region(?p)) @t+1 else plan-failure
)";
constexpr const char* kPlan = R"(
(defun go-to (?x)
  (let ((?p (make-pose-stamped "map" 0.0 (make-3d-vector ?x 0 0) (make-identity-rotation))))
    (perform (a motion (type going) (pose ?p)))))
(dotimes (i 6) (go-to 1.5) (go-to 0.5))
)";

std::int64_t clauses_up_to(const compiler::CompiledModel& model, compiler::Timepoint n) {
  return std::count_if(model.clause_timepoints.begin(), model.clause_timepoints.end(),
                       [&](compiler::Timepoint t) { return t <= n; });
}

TEST_CASE("session: one solver for the whole run, and each clause is handed over once") {
  PlannedModel model(kModel, kPlan, kBinding, "HoldsAt(At(b2),time)", 12);
  REQUIRE(model.codes() == "");
  Ledger ledger;
  runtime::SolverSession session(model.compiled(), std::make_unique<CountingSolver>(ledger));
  CHECK(ledger.clauses == 0);
  runtime::PlanEnumerator enumerator(session, {.all_hits = true});
  std::vector<compiler::Timepoint> lengths;
  std::int64_t of_the_model = 0;
  while (const auto trace = enumerator.next()) {
    lengths.push_back(trace->length());
    // A trace may end early only if the model can go on from there, so all timepoints are loaded
    // here.
    CHECK(session.loaded() == model.compiled().horizon);
    const auto after = ledger;
    // The caller simulates here: nothing is solved and nothing handed over meanwhile.
    CHECK(runtime::event_key(*trace).size() > 0);
    CHECK(ledger.calls == after.calls);
    CHECK(ledger.clauses == after.clauses);
    of_the_model = clauses_up_to(model.compiled(), session.loaded());
    CHECK(ledger.clauses >= of_the_model);
    // The session's own clauses, guards and blocking clauses, are few compared with the model's.
    CHECK(ledger.clauses < of_the_model + 100 * session.loaded());
  }
  CHECK(lengths == std::vector<compiler::Timepoint>{1, 3, 5, 7, 9, 11});
  CHECK(enumerator.exploration() == runtime::Exploration::kAllTracesExplored);
}

TEST_CASE("session: a horizon can be asked for again after a longer one") {
  PlannedModel model(kModel, kPlan, kBinding, "HoldsAt(At(b2),time)", 12);
  Ledger ledger;
  runtime::SolverSession session(model.compiled(), std::make_unique<CountingSolver>(ledger));
  const compiler::AtomIndex index(model.compiled());
  const auto in_b2 = [&](compiler::Timepoint t) {
    return *index.find(compiler::AtomKind::kHoldsAt, "At(b2)", t);
  };
  for (const compiler::Timepoint n : {3, 12, 1, 7}) {
    CAPTURE(n);
    const auto there = in_b2(n % 2 == 1 ? n : n - 1);
    CHECK(session.solve(n, std::vector{there}) == SolveStatus::kSatisfiable);
    session.require_model(n);
    CHECK(session.value(there));
    CHECK(session.solve(n, std::vector{~there}) == SolveStatus::kUnsatisfiable);
  }
  CHECK(session.loaded() == 12);
  CHECK(ledger.clauses == clauses_up_to(model.compiled(), 12));
}

TEST_CASE("session: variables that no clause has mentioned yet are free, then bound") {
  PlannedModel model(kModel, kPlan, kBinding, "HoldsAt(At(b2),time)", 12);
  runtime::SolverSession session(model.compiled(), runtime::make_cadical_solver());
  const compiler::AtomIndex index(model.compiled());
  const auto late = *index.find(compiler::AtomKind::kHoldsAt, "At(b2)", 11);
  CHECK_FALSE(session.is_fixed(late));
  // Clauses of the caller may speak of later timepoints than were solved so far.
  session.add_clause(std::vector{~late});
  CHECK(session.solve(5, {}) == SolveStatus::kSatisfiable);
  CHECK(session.solve(11, {}) == SolveStatus::kUnsatisfiable);
}

}  // namespace
}  // namespace parallax::test
