#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

/// A minimal set of origins (indices into `model.origins`, ascending) whose clauses cannot hold
/// together up to timepoint `n`: dropping any one of them makes the rest satisfiable. None if the
/// model is satisfiable. `solver` is fresh. Cost: one call, then one for each member of the first
/// core.
std::optional<std::vector<std::uint32_t>> find_unsat_core(const compiler::CompiledModel& model,
                                                          compiler::Timepoint n,
                                                          std::unique_ptr<SatSolver> solver);

}  // namespace parallax::runtime
