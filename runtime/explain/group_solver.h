#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/explain/axiom_groups.h"
#include "runtime/explain/effort.h"
#include "runtime/explain/execution_formula.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

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

/// The axioms of a model, by group. `solver` is fresh.
GroupSolver load_axioms(ExecutionFormula& formula, const AxiomGroups& groups,
                        std::unique_ptr<SatSolver> solver);

}  // namespace parallax::runtime
