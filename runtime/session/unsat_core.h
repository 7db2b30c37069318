#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

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
