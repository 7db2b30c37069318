#pragma once

#include <cstddef>
#include <vector>

namespace parallax::compiler {

/// Strongly connected components of a graph (Tarjan 1972): `needs` lists for each node those that
/// it needs. A component comes after all that it needs; its nodes ascend. Linear; no recursion.
std::vector<std::vector<std::size_t>> strong_components(
    const std::vector<std::vector<std::size_t>>& needs);

}  // namespace parallax::compiler
