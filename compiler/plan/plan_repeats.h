#pragma once

#include <vector>

#include "compiler/plan/plan_graph.h"

namespace parallax::compiler {

/// For every location: the earlier attempts that it repeats, sorted. An attempt is a location of
/// the same perform form with the same event, behind whose failure the location can come; itself
/// too, where control can return. Looks at no more than `max_visits` places; what comes after that
/// repeats nothing.
std::vector<std::vector<LocationId>> earlier_attempts(const PlanGraph& graph,
                                                      std::size_t max_visits = 20'000'000);

}  // namespace parallax::compiler
