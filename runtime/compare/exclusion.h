#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// A minimal set of origins (indices, ascending) whose clauses up to timepoint `by` cannot hold
/// together with the observation: dropping any one of them lets it pass. Origins for which
/// `dispensable` says yes are dropped first, so that those of them that remain are needed with all
/// others at hand. Empty if the solver was stopped. The observation is no trace of the model.
/// Cost: a solver call for each member of the first core.
std::vector<std::uint32_t> excluding_origins(const compiler::CompiledModel& model,
                                             compiler::Timepoint by,
                                             std::span<const compiler::Literal> observation,
                                             const std::function<bool(std::uint32_t)>& dispensable,
                                             const std::atomic<bool>* stop);

}  // namespace parallax::runtime
