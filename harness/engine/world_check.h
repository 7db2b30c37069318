#pragma once

#include <vector>

#include "harness/world/structure_check.h"

namespace parallax::harness {

/// Everything wrong with `spec`: its structure, and then what cannot work whatever the start, which
/// takes building it. Empty: OdeWorld takes it.
std::vector<WorldProblem> check_world(const WorldSpec& spec);

}  // namespace parallax::harness
