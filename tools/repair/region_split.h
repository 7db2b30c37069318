#pragma once

#include "tools/repair/proposal.h"

namespace parallax::tools {

/// Where one or two parameters of the start tell the runs that left the model at one step from
/// those that did not, the start is split there: a fluent for each border says how a thing began,
/// starts are drawn on its side, and the event does in the part what was seen there. Of runs that
/// went otherwise the proposal says so: in the part they are set aside (a precaution), outside
/// they are what is left. Where there are too few runs to tell, a hint says how to make more.
FoundProposals region_splits(const RepairInput& input, Context& context);

}  // namespace parallax::tools
