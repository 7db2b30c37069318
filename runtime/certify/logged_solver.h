#pragma once

#include <atomic>
#include <cstdio>
#include <memory>

#include "runtime/certify/completeness_claim.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

/// A solver for a session that looks for traces in many calls, whose log is a DRAT proof of what
/// the calls found: in the end, if they found all traces, of the claim.
///
/// Clauses that are added before the first call are those of the model. Later ones that only have
/// variables of the claim are taken for its blocking clauses, unless they are units; the others
/// are logged, the literal of their largest variable first: if that is new, the clause is a
/// definition, which DRAT admits (RAT). What an unsatisfiable call shows is logged as the clause
/// that its assumptions contradict each other.
///
/// The log is checked like any other proof: nothing here has to be trusted. `proof` outlives the
/// solver and is the caller's to flush and to ask for errors.
std::unique_ptr<SatSolver> make_logged_solver(std::FILE* proof, const CompletenessClaim& claim,
                                              const std::atomic<bool>* stop = nullptr);

}  // namespace parallax::runtime
