#pragma once

#include "tools/repair/proposal.h"

namespace parallax::tools {

/// Splits the start where one or two of its parameters separate the runs that left the model at one
/// step from the others: a fluent for each border tells where a thing began, starts are drawn on
/// its side, and in the failing part the event has the observed effect. Runs that do not fit are
/// counted in the proposal: inside the part they are set aside (a precaution), outside they remain.
/// Where there are too few runs to decide, a hint tells how to make more.
FoundProposals region_splits(const RepairInput& input, Context& context);

}  // namespace parallax::tools
