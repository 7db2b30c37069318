#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace parallax::runtime {

/// The order in which vertices 0 .. `vertices` - 1 are eliminated by least degree: each one's
/// neighbours become neighbours of each other (Markowitz 1957; its tree is a tree decomposition,
/// the most neighbours that one has when it goes the width). `cliques`: sets of vertices that are
/// neighbours. Vertices with a higher `stage` wait until those of lower stages are gone; among
/// equals the last one goes first. None: more than `most_edges` would be made on the way.
std::optional<std::vector<std::uint32_t>> elimination_order(
    std::size_t vertices, std::span<const std::vector<std::uint32_t>> cliques,
    std::span<const std::uint8_t> stage, std::size_t most_edges);

}  // namespace parallax::runtime
