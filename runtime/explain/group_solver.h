#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

/// Facts that are not in question: the observations of one execution.
struct Observed {
  compiler::Timepoint length = 0;  // it went so far
  std::vector<compiler::Literal> facts;
};

/// "There is a trace", clause by clause of the model, so that clauses can be left out.
///
/// Without state constraints a trace satisfies every clause. With constraints it ends at some
/// timepoint from 1 on at which they hold, and satisfies the clauses up to there: variables beyond
/// the model's choose the length, and a clause of timepoint t > 0 binds if the trace reaches t.
/// With an observation the length is the observed one, and its facts hold.
class ExecutionFormula {
 public:
  /// `model` outlives the object.
  explicit ExecutionFormula(const compiler::CompiledModel& model,
                            std::optional<Observed> observed = std::nullopt);

  const compiler::CompiledModel& model() const { return model_; }
  std::int32_t variables() const { return variables_; }
  /// Says nothing by itself: it defines an auxiliary.
  bool is_definition(std::size_t clause) const { return model_.clause_is_definition[clause]; }
  /// Clause `index` of the model; the view lasts until the next call.
  std::span<const compiler::Literal> clause(std::size_t index);
  /// Visits the clauses that always hold: the length, the definitions, the observed facts.
  void for_each_always(const std::function<void(std::span<const compiler::Literal>)>& visit);

 private:
  bool is_guarded() const { return model_.has_constraints || observed_.has_value(); }
  void choose_length(const std::function<void(std::span<const compiler::Literal>)>& visit) const;
  compiler::Literal reaches(compiler::Timepoint t) const;
  compiler::Literal ends(compiler::Timepoint n) const;

  const compiler::CompiledModel& model_;
  std::optional<Observed> observed_;
  std::int32_t variables_;
  std::vector<compiler::Literal> clause_;
};

/// The origins of a model grouped by their source text, since an explanation names places in source
/// files. State invariants belong to no group: they follow from the others.
struct AxiomGroups {
  static constexpr std::uint32_t kNone = UINT32_MAX;
  std::vector<std::vector<std::uint32_t>> origins;  // by group, ascending; groups in source order
  std::vector<std::uint32_t> group_of;              // by origin; kNone: of no group
  std::size_t size() const { return origins.size(); }
};

/// Groups the origins that have clauses.
AxiomGroups group_axioms(const compiler::CompiledModel& model);

/// Budget of the solver for making sets smaller, in conflicts, so that the result is the same on
/// every machine. One question gets at most a tenth of it.
class Effort {
 public:
  explicit Effort(std::int64_t conflicts)
      : left_(conflicts), share_(std::max<std::int64_t>(conflicts / 10, 1)) {}

  bool is_spent() const { return left_ <= 0; }
  /// Conflicts that the next question may take.
  std::int64_t share() const { return std::min(left_, share_); }
  /// Charges a question; each one counts, however easy it was.
  void spend(std::int64_t conflicts) { left_ -= conflicts + 1; }

 private:
  std::int64_t left_, share_;
};

/// A set of numbers, ascending.
using IndexSet = std::vector<std::uint32_t>;

/// Clauses in groups, which hold while they are selected. Definitions of auxiliaries always hold.
class GroupSolver {
 public:
  /// `solver` is fresh.
  GroupSolver(std::int32_t variables, std::size_t groups, std::unique_ptr<SatSolver> solver);

  void add(std::span<const Literal> clause, std::uint32_t group);
  void add_definition(std::span<const Literal> clause) { solver_->add_clause(clause); }

  /// kUnknown also where the effort, which may be null, did not suffice.
  SolveStatus solve(const IndexSet& groups, Effort* effort = nullptr);
  /// After kUnsatisfiable: the groups that the solver used, a subset of those that were asked for.
  IndexSet core() const;
  /// After kSatisfiable: groups whose clauses hold in the valuation found, among them those asked
  /// for. May miss some.
  IndexSet satisfied() const;
  std::size_t group_count() const { return groups_; }
  std::int64_t solve_calls() const { return solver_->solve_calls(); }

 private:
  Literal selector(std::uint32_t group) const {
    return Literal::positive(variables_ + 1 + static_cast<std::int32_t>(group));
  }
  std::unique_ptr<SatSolver> solver_;
  std::int32_t variables_;
  std::size_t groups_;
  IndexSet asked_;
  std::vector<Literal> clause_;
};

/// The axioms of a model, by group, and behind them `more` groups that are empty yet. `solver` is
/// fresh.
GroupSolver load_axioms(ExecutionFormula& formula, const AxiomGroups& groups,
                        std::unique_ptr<SatSolver> solver, std::size_t more = 0);

}  // namespace parallax::runtime
