#pragma once

#include <cstddef>
#include <vector>

#include "runtime/session/solver_session.h"

namespace parallax::runtime {

/// The steps of the plan that only repeat, and in vain: after one of their earlier attempts has
/// failed (`earlier`, by step) they can still be reached within the horizon, but succeed in no
/// execution from any initial state. Sorted. Two solver calls for every step that has earlier
/// attempts. A solver that gives up makes no step dead.
std::vector<std::size_t> dead_steps(SolverSession& session,
                                    const std::vector<std::vector<std::size_t>>& earlier);

/// Can one of these steps be reached within the horizon and fail? A solver that gives up says yes.
/// At most one solver call.
bool can_fail(SolverSession& session, const std::vector<std::size_t>& steps);

}  // namespace parallax::runtime
