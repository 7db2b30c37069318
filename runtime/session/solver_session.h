#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

using compiler::CompiledModel;
using compiler::Timepoint;

/// Variables beyond those of a model, which bind its clauses and the search to a length.
/// Enumerators and the formula that a proof refutes number them alike.
class LengthVariables {
 public:
  explicit LengthVariables(const compiler::CompiledModel& model)
      : first_(model.variable_count()), horizon_(model.horizon) {}

  /// The clauses of timepoint t, 1 .. horizon, hold.
  compiler::Literal reaches(compiler::Timepoint t) const { return at(t); }
  /// A trace of a model with state constraints ends at n, 0 .. horizon.
  compiler::Literal ends(compiler::Timepoint n) const { return at(horizon_ + 1 + n); }
  /// It does not end within the horizon.
  compiler::Literal goes_on() const { return at(2 * horizon_ + 2); }
  /// The last of these variables.
  std::int32_t last() const { return first_ + 2 * horizon_ + 2; }

 private:
  compiler::Literal at(std::int32_t i) const { return compiler::Literal::positive(first_ + i); }
  std::int32_t first_;
  compiler::Timepoint horizon_;
};

/// When a session hands clauses to its solver.
enum class Loading : std::uint8_t {
  kAsNeeded,  // those of a timepoint with the first call that needs them
  kWhole,     // all before the first call, with the model's own numbers: for solvers that log
  /// All as they stand, for any valuation of the full horizon: no guards, and no value is
  /// preferred.
  kWitness,
};

/// Has the model clauses that bind a trace up to its end only, and not the model's states behind
/// it: those of a plan, and of the bounds of objectives?
bool has_ending_clauses(const CompiledModel& model);
/// Is this one of them? A definition never is.
bool ends_with_trace(const CompiledModel& model, std::size_t clause);

/// One solver for one compiled model, whose horizon is chosen per call. Every clause of timepoint t
/// carries the guard of t; a call with horizon n assumes the guards 1 .. n and drops the others, so
/// learned clauses survive from one horizon to the next. As a rule the clauses of a timepoint, and
/// with them its variables, are added with the first call that needs them: short horizons pay
/// nothing for the long one.
class SolverSession {
 public:
  SolverSession(const CompiledModel& model, std::unique_ptr<SatSolver> solver,
                Loading loading = Loading::kAsNeeded);

  const CompiledModel& model() const { return *model_; }
  const LengthVariables& lengths() const { return lengths_; }
  /// Hands the clauses of horizon `n` to the solver, as the first call that needs them would.
  void load(Timepoint n);
  /// A variable of the session's own, for guards.
  Literal new_variable();
  void add_clause(std::span<const Literal> clause);
  /// Is there a valuation with horizon `n` under these assumptions? `values()` has it afterwards.
  SolveStatus solve(Timepoint n, std::span<const Literal> assumptions);
  /// The same for a valuation up to `n` that the model, without its plan, can continue to its
  /// horizon: after a trace has ended nobody performs the rest of the plan. Two calls where such a
  /// valuation may exist: the first, which only needs the clauses up to `n`, refutes most of what
  /// can be refuted.
  SolveStatus solve_whole(Timepoint n, std::span<const Literal> assumptions);
  /// Is there a valuation of one of these lengths, at least 1, in which the length's literal is
  /// true? One call: what contradicts one length mostly contradicts the others. Hands over all
  /// clauses and keeps no values. Call once, after another call.
  SolveStatus solve_some_length(const std::map<Timepoint, Literal>& ends);
  /// Limits each solver call of the next `solve` or `solve_whole`, which then answers kUnknown.
  void limit_conflicts(std::int64_t most) { limit_ = most; }
  /// Value of a literal in the valuation that the last satisfiable call found; it stays available
  /// until the next satisfiable call.
  bool value(Literal literal) const;
  /// Evaluates every clause of horizon `n` on the valuation at hand, without the solver: a solver
  /// that answers wrongly is a broken contract. Linear in the clauses.
  void require_model(Timepoint n) const;
  bool is_fixed(Literal literal) const;
  /// After an unsatisfiable call: is the assumption one that made it so?
  bool failed(Literal assumption) { return solver_->failed(in_solver(assumption)); }
  /// From now on the search tries the literal true first.
  void prefer(Literal literal) { solver_->set_phase(in_solver(literal)); }
  std::int64_t solve_calls() const { return solver_->solve_calls(); }
  /// The largest horizon that was asked for, whose clauses the solver has; -1: none yet.
  Timepoint loaded() const { return loaded_; }

 private:
  SolveStatus solve(Timepoint n, Timepoint plan, std::span<const Literal> assumptions);
  void load_clause(std::size_t clause);
  void sort_by_timepoint();
  Literal in_solver(Literal literal);
  const CompiledModel* model_;  // outlives the session
  std::unique_ptr<SatSolver> solver_;
  LengthVariables lengths_;
  std::int32_t variable_count_ = 0;
  Loading loading_;
  bool has_ending_clauses_;
  std::vector<Literal> guards_;  // by timepoint - 1; of clauses that end with the trace later
  std::vector<bool> values_;     // by variable - 1
  Timepoint loaded_ = -1;
  std::vector<std::vector<std::uint32_t>> clauses_at_;  // by timepoint; filled when first needed
  std::vector<std::int32_t> solver_variables_;          // by variable - 1; 0: not handed over yet
  std::int32_t solver_variable_count_ = 0;
  std::vector<Literal> scratch_;
  std::optional<std::int64_t> limit_;  // of conflicts, for the next call
};

/// A model in a solver of its own, in which the clauses of an origin (an index into
/// `model.origins`) hold while the origin is selected. Definitions of auxiliaries always hold;
/// invariants, which follow from the rest, are left out.
class SelectedOrigins {
 public:
  /// The clauses up to timepoint `n`. `solver` is fresh.
  SelectedOrigins(const compiler::CompiledModel& model, compiler::Timepoint n,
                  std::unique_ptr<SatSolver> solver);

  /// `literal` holds from now on, whatever is selected.
  void require(compiler::Literal literal) { solver_->add_clause(std::span(&literal, 1)); }
  SolveStatus solve(std::span<const std::uint32_t> origins);
  /// After an unsatisfiable call: was this origin, selected there, part of the contradiction?
  bool failed(std::uint32_t origin) const { return solver_->failed(selector(origin)); }
  /// After an unsatisfiable call: takes the origins away that were no part of the contradiction.
  void keep_failed(std::vector<std::uint32_t>& origins) const {
    std::erase_if(origins, [&](std::uint32_t origin) { return !failed(origin); });
  }

 private:
  compiler::Literal selector(std::uint32_t origin) const {
    return compiler::Literal::positive(first_selector_ + static_cast<std::int32_t>(origin));
  }
  std::unique_ptr<SatSolver> solver_;
  std::int32_t first_selector_;
};

struct NeededOrigins {
  std::vector<std::uint32_t> origins;  // ascending
  /// The solver was stopped: candidates not tried until then count as needed.
  bool stopped = false;
};

/// Shrinks `candidates` to a set that contradicts itself (and what `selected` requires) and of
/// which none can be left out. Deletion: the candidates are tried from the end; one that is not
/// needed goes, together with all that its absence frees. The candidates must contradict each
/// other. Cost: at most one solver call for each.
NeededOrigins shrink_to_needed(SelectedOrigins& selected, std::vector<std::uint32_t> candidates);

struct UnsatCore {
  /// Has the model a valuation? With kUnsatisfiable the core stands below.
  SolveStatus status = SolveStatus::kUnknown;
  /// Origins (indices into `model.origins`, ascending) whose clauses cannot hold together.
  std::vector<std::uint32_t> origins;
  /// Dropping any one of them makes the rest satisfiable. Else the solver was stopped.
  bool is_minimal = false;
};

/// A minimal set of origins whose clauses up to timepoint `n` contradict each other. `solver` is
/// fresh. Cost: one call, then one for each member of the first core.
UnsatCore find_unsat_core(const compiler::CompiledModel& model, compiler::Timepoint n,
                          std::unique_ptr<SatSolver> solver);

}  // namespace parallax::runtime
