// One solver for all horizons of a model, by guards.
//
// Each clause carries the negated guard of its timepoint, the latest that its atoms mention; a
// call with horizon n assumes the guards 1 to n and drops the others. Learned clauses contain
// the guards that they rest on, so they survive from one horizon to the next. The clauses of a
// timepoint are handed over with the first call that needs them; while a caller simulates a
// trace the solver waits. A trace that ends at n is the beginning of a valuation of the whole
// horizon (solve_whole): the clauses of a plan and of objectives have guards of their own and
// bind up to n only, and the call for the whole horizon comes second, after one that needs the
// clauses up to n alone, refutes most of what can be refuted and orders what is left.
//
// A core is shrunk by deletion: a member that is not needed goes, with all that the solver did
// not use without it. Cost: one call for each member of the first core.

#include "runtime/session/solver_session.h"

#include <algorithm>
#include <array>
#include <utility>

namespace parallax::runtime {

SolverSession::SolverSession(const CompiledModel& model, std::unique_ptr<SatSolver> solver,
                             Loading loading)
    : model_(&model),
      solver_(std::move(solver)),
      lengths_(model),
      variable_count_(lengths_.last()),
      loading_(loading),
      has_ending_clauses_(has_ending_clauses(model)) {
  PARALLAX_REQUIRE(!model.folded, "a model with all copies of its clauses");
  for (Timepoint t = 1; t <= model.horizon; ++t) guards_.push_back(lengths_.reaches(t));
  // Behind them those of clauses that end with the trace.
  for (Timepoint t = 1; t <= model.horizon && has_ending_clauses_; ++t) {
    guards_.push_back(Literal::positive(++variable_count_));
  }
  values_.resize(static_cast<std::size_t>(model.variable_count()));
  if (loading_ == Loading::kWhole) load(model.horizon);
}

bool has_ending_clauses(const CompiledModel& model) {
  return !model.plan.empty() ||
         std::any_of(model.origins.begin(), model.origins.end(), [](const auto& origin) {
           return origin.kind == compiler::OriginKind::kObjective;
         });
}

bool ends_with_trace(const CompiledModel& model, std::size_t clause) {
  // Models that were made for one question have no origins.
  if (model.clause_is_definition[clause] || clause >= model.clause_origins.size()) return false;
  const auto kind = model.origins[model.clause_origins[clause]].kind;
  return kind == compiler::OriginKind::kObjective ||
         (kind == compiler::OriginKind::kPlanStep && !model.plan.empty());
}

Literal SolverSession::new_variable() { return Literal::positive(++variable_count_); }

/// The solver numbers variables in the order in which it meets them, unless the whole model is
/// loaded: then the numbers are ours.
Literal SolverSession::in_solver(Literal literal) {
  const auto place = static_cast<std::size_t>(literal.var()) - 1;
  if (place >= solver_variables_.size()) {
    solver_variables_.resize(static_cast<std::size_t>(variable_count_), 0);
  }
  auto& number = solver_variables_[place];
  if (number == 0) {
    number = loading_ == Loading::kWhole ? literal.var() : ++solver_variable_count_;
    // The first solution that the search tries is the canonical one as often as possible.
    if (literal.var() <= model_->variable_count() && loading_ != Loading::kWitness) {
      solver_->set_phase(~Literal::positive(number));
    }
  }
  const auto known = Literal::positive(number);
  return literal.is_positive() ? known : ~known;
}

void SolverSession::add_clause(std::span<const Literal> clause) {
  scratch_.clear();
  for (const auto literal : clause) scratch_.push_back(in_solver(literal));
  solver_->add_clause(scratch_);
}

bool SolverSession::is_fixed(Literal literal) const {
  const auto place = static_cast<std::size_t>(literal.var()) - 1;
  if (place >= solver_variables_.size() || solver_variables_[place] == 0) return false;
  const auto known = Literal::positive(solver_variables_[place]);
  return solver_->is_fixed(literal.is_positive() ? known : ~known);
}

void SolverSession::sort_by_timepoint() {
  clauses_at_.resize(static_cast<std::size_t>(model_->horizon) + 1);
  for (std::size_t i = 0; i < model_->clauses.size(); ++i) {
    clauses_at_[static_cast<std::size_t>(model_->clause_timepoints[i])].push_back(
        static_cast<std::uint32_t>(i));
  }
}

void SolverSession::load_clause(std::size_t clause) {
  const auto t = model_->clause_timepoints[clause];
  const auto literals = model_->clauses[clause];
  scratch_.clear();
  for (const auto literal : literals) scratch_.push_back(in_solver(literal));
  // A definition of an auxiliary is harmless at any horizon.
  if (t > 0 && !model_->clause_is_definition[clause] && loading_ != Loading::kWitness) {
    const bool ends = has_ending_clauses_ && ends_with_trace(*model_, clause);
    const auto first = ends ? static_cast<std::size_t>(model_->horizon) : 0;
    scratch_.push_back(~in_solver(guards_[first + static_cast<std::size_t>(t) - 1]));
  }
  solver_->add_clause(scratch_);
}

/// Hands over the clauses up to timepoint n. Variables are numbered as in the model, as far as
/// they are new: the order in which a search decides follows it.
void SolverSession::load(Timepoint n) {
  if (n <= loaded_) return;
  std::vector<bool> used(values_.size());
  std::vector<std::uint32_t> clauses;
  if (clauses_at_.empty()) sort_by_timepoint();
  for (Timepoint t = loaded_ + 1; t <= n; ++t) {
    const auto& more = clauses_at_[static_cast<std::size_t>(t)];
    clauses.insert(clauses.end(), more.begin(), more.end());
  }
  std::sort(clauses.begin(), clauses.end());
  for (const auto clause : clauses) {
    for (const auto literal : model_->clauses[clause]) {
      used[static_cast<std::size_t>(literal.var()) - 1] = true;
    }
  }
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) in_solver(Literal::positive(static_cast<std::int32_t>(v) + 1));
  }
  for (const auto clause : clauses) load_clause(clause);
  loaded_ = n;
}

SolveStatus SolverSession::solve(Timepoint n, std::span<const Literal> assumptions) {
  return solve(n, n, assumptions);
}

/// `n`: how far the model goes; `plan`: and how far its plan.
SolveStatus SolverSession::solve(Timepoint n, Timepoint plan,
                                 std::span<const Literal> assumptions) {
  load(std::min(n, model_->horizon));
  PARALLAX_REQUIRE(loading_ != Loading::kWitness || n == model_->horizon,
                   "without guards there is one horizon");
  for (Timepoint t = 1; t <= loaded_ && loading_ != Loading::kWitness; ++t) {
    const auto guard = in_solver(guards_[static_cast<std::size_t>(t) - 1]);
    solver_->assume(t <= n ? guard : ~guard);
    if (!has_ending_clauses_) continue;
    const auto of_plan = in_solver(guards_[static_cast<std::size_t>(model_->horizon + t) - 1]);
    solver_->assume(t <= plan ? of_plan : ~of_plan);
  }
  for (const auto literal : assumptions) solver_->assume(in_solver(literal));
  if (limit_) solver_->limit_conflicts(*std::exchange(limit_, std::nullopt));
  const auto status = solver_->solve();
  if (status == SolveStatus::kSatisfiable) {
    for (std::size_t v = 0; v < values_.size(); ++v) {
      const bool known = v < solver_variables_.size() && solver_variables_[v] != 0;
      values_[v] = known && solver_->value(Literal::positive(solver_variables_[v]));
    }
  }
  return status;
}

SolveStatus SolverSession::solve_whole(Timepoint n, std::span<const Literal> assumptions) {
  if (n >= model_->horizon) return solve(n, assumptions);
  const auto limit = limit_;
  const auto status = solve(n, assumptions);
  if (status != SolveStatus::kSatisfiable) return status;
  limit_ = limit;
  return solve(model_->horizon, n, assumptions);
}

/// The new variable is defined as "one of the literals is true", so that a proof may log it. A
/// length whose literal is true has to be reached, and with it all shorter ones.
SolveStatus SolverSession::solve_some_length(const std::map<Timepoint, Literal>& ends) {
  PARALLAX_REQUIRE(loading_ != Loading::kWitness, "without guards there is one horizon");
  load(model_->horizon);
  const auto some = new_variable();
  std::vector<Literal> any = {~some};
  for (Timepoint t = 2; t <= model_->horizon; ++t) {
    add_clause(std::array{~lengths_.reaches(t), lengths_.reaches(t - 1)});
  }
  for (const auto& [t, literal] : ends) {
    add_clause(std::array{some, ~literal});
    add_clause(std::array{~some, ~literal, lengths_.reaches(t)});
    any.push_back(literal);
  }
  add_clause(any);
  solver_->assume(in_solver(some));
  if (limit_) solver_->limit_conflicts(*std::exchange(limit_, std::nullopt));
  return solver_->solve();
}

void SolverSession::require_model(Timepoint n) const {
  for (std::size_t i = 0; i < model_->clauses.size(); ++i) {
    if (model_->clause_timepoints[i] > n) continue;
    const auto clause = model_->clauses[i];
    PARALLAX_REQUIRE(
        std::any_of(clause.begin(), clause.end(), [&](Literal literal) { return value(literal); }),
        "the solver's valuations satisfy every clause");
  }
}

bool SolverSession::value(Literal literal) const {
  PARALLAX_REQUIRE(static_cast<std::size_t>(literal.var()) <= values_.size(),
                   "a value of a model variable is asked after a satisfiable call");
  return values_[static_cast<std::size_t>(literal.var()) - 1] == literal.is_positive();
}

SelectedOrigins::SelectedOrigins(const compiler::CompiledModel& model, compiler::Timepoint n,
                                 std::unique_ptr<SatSolver> solver)
    : solver_(std::move(solver)), first_selector_(model.variable_count() + 1) {
  std::vector<compiler::Literal> clause;
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    const auto origin = model.clause_origins[i];
    if (model.clause_timepoints[i] > n) continue;
    if (model.origins[origin].kind == compiler::OriginKind::kInvariant) continue;
    clause.assign(model.clauses[i].begin(), model.clauses[i].end());
    if (!model.clause_is_definition[i]) clause.push_back(~selector(origin));
    solver_->add_clause(clause);
  }
}

SolveStatus SelectedOrigins::solve(std::span<const std::uint32_t> origins) {
  for (const auto origin : origins) solver_->assume(selector(origin));
  return solver_->solve();
}

NeededOrigins shrink_to_needed(SelectedOrigins& selected, std::vector<std::uint32_t> candidates) {
  NeededOrigins result;
  auto& needed = result.origins;
  while (!candidates.empty() && !result.stopped) {
    const auto tried = candidates.back();
    candidates.pop_back();
    auto rest = needed;
    rest.insert(rest.end(), candidates.begin(), candidates.end());
    const auto status = selected.solve(rest);
    if (status == SolveStatus::kUnsatisfiable) {
      selected.keep_failed(candidates);
    } else {
      needed.push_back(tried);
      result.stopped = status == SolveStatus::kUnknown;
    }
  }
  needed.insert(needed.end(), candidates.begin(), candidates.end());
  std::sort(needed.begin(), needed.end());
  return result;
}

UnsatCore find_unsat_core(const compiler::CompiledModel& model, compiler::Timepoint n,
                          std::unique_ptr<SatSolver> solver) {
  SelectedOrigins selected(model, n, std::move(solver));
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t i = 0; i < model.origins.size(); ++i) candidates.push_back(i);
  const auto status = selected.solve(candidates);
  if (status != SolveStatus::kUnsatisfiable) return {status, {}, false};
  selected.keep_failed(candidates);
  auto needed = shrink_to_needed(selected, std::move(candidates));
  return {status, std::move(needed.origins), !needed.stopped};
}

}  // namespace parallax::runtime
