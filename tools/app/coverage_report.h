#pragma once

#include <string>

#include "tools/app/coverage.h"

namespace parallax::tools {

/// How much of each group was simulated, and what was not, by place.
std::string coverage_text(const Coverage& coverage);

/// One object: each group is a list of {"id", "file", "line", "column", "hits", "traces"}, in the
/// order of places.
std::string coverage_json(const Coverage& coverage);

/// A tracefile as `lcov` writes it and `genhtml` reads it: a record for each file of models and
/// plans, lines with the simulations that reached them, events and handlers as functions, outcomes
/// and conditions as branches.
std::string coverage_lcov(const Coverage& coverage);

}  // namespace parallax::tools
