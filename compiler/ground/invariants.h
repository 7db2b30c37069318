#pragma once

#include <vector>

#include "compiler/ground/ground_model.h"
#include "compiler/ground/meetings.h"

namespace parallax::compiler {

/// Finds groups of fluents of which at most one, or exactly one, holds at every timepoint, and adds
/// that to the model (mutex groups, Helmert 2009, for the Event Calculus): the instances of a
/// fluent symbol that differ in one argument. A group is taken if the values at 0 are stated and
/// the effect rows keep it, whatever set of events happens: an event that initiates one member
/// finds the others false or terminates them, and no two initiations can coincide. Preconditions
/// and exclusions of events that hold at every timepoint are taken into account. The traces stay
/// the same. Quadratic in the rows of a group; groups beyond kMaxGroup members or kMaxGroupRows
/// rows are left alone. `known` are groups that at_most_one_groups found; of `clique` members on
/// they are said by blocks (at_most_one.h).
void add_invariants(GroundModel& model, const EffectRows& rows,
                    const std::vector<FluentGroup>& known, const Meetings& meetings,
                    std::size_t clique);

/// The groups of which at most one holds, as far as the constraints so far show it.
std::vector<FluentGroup> at_most_one_groups(GroundModel& model, const EffectRows& rows);

inline constexpr std::size_t kMaxGroup = 64;
inline constexpr std::size_t kMaxGroupRows = 1024;

}  // namespace parallax::compiler
