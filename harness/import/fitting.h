#pragma once

#include <map>
#include <string>

#include "harness/import/description.h"

namespace parallax::harness {

/// Makes of a description what the simulator can have, and lists each change as left out:
/// joints whose stops leave no way are fixed; joints stand where `positions` says, or else at the
/// nearest position within their stops, from where their angles then count; and inertias that no
/// body has are replaced. Returns a fault where `positions` names no joint, or one beyond its
/// stops.
std::optional<TextFault> fit_joints(const std::map<std::string, double>& positions,
                                    Description& description);

/// Gives links without mass what they need to stand or to move: a root stands fast, a link at the
/// end of a joint is held fast to what the joint hangs on, and a link between two joints gets a
/// share of the mass behind it. Links must not be fixed to each other any more. Returns whether
/// anything was fixed to anything, so that they may be again.
bool fit_massless(Description& description);

/// Replaces inertias that no body has.
void fit_inertias(Description& description);

/// The share of the mass of a body that each joint before its last one gets, where several joints
/// move it.
inline constexpr double kSharedMass = 0.02;

}  // namespace parallax::harness
