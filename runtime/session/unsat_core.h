#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

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
  /// The solver was stopped: what was not tried until then counts as needed.
  bool stopped = false;
};

/// What of `candidates` contradicts itself (and what `selected` requires) so that none can be left
/// out. Deletion: the candidates are tried from the end; one that is not needed goes, together with
/// all that its absence frees. The candidates contradict each other. Cost: at most one solver call
/// for each.
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
