#pragma once

#include <gmpxx.h>

#include <cstddef>
#include <optional>
#include <span>

#include "runtime/graph/model_traces.h"
#include "runtime/symmetry/interchangeable.h"

namespace parallax::runtime {

/// How many orbits the traces of a model have, and how many traces they are.
struct OrbitNumber {
  mpz_class orbits, traces;
  std::size_t counted = 0;  // symmetries whose unchanged traces were counted
};

/// Symmetries that may be asked; more take too long.
inline constexpr std::size_t kMostAsked = 1'000;

/// Counts the orbits of a model without constraints, at its full horizon, without listing them:
/// their number is the mean over all symmetries of the number of traces that each leaves as they
/// are (Cauchy and Frobenius; Burnside 1911), which is the same for symmetries that are conjugate.
/// The traces that a symmetry leaves as they are, are those of the model with clauses that require
/// this. `model` has `symmetry`, which is not empty. None: more than kMostAsked symmetries would
/// have to be asked, or so many that to list the orbits takes less, or some traces could not be
/// counted, or it was stopped.
std::optional<OrbitNumber> count_orbits(const CompiledModel& model, const ModelSymmetry& symmetry,
                                        const TraceQuery& query);

/// The model with clauses by which `symmetry` leaves its traces as they are, told apart by
/// `observed`.
CompiledModel model_left_by(const CompiledModel& model, const NodeMap& symmetry,
                            std::span<const Literal> observed);

}  // namespace parallax::runtime
