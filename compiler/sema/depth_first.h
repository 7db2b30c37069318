#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace parallax::compiler {

/// Edges of a graph: for each vertex the vertices it leads to.
using Graph = std::vector<std::vector<std::uint32_t>>;

/// An edge that closes a circle: edge number `edge` of the last vertex of `path` leads back to one
/// of the path. path[i] leads to path[i + 1] by its edge number edges[i].
struct Circle {
  std::vector<std::uint32_t> path;
  std::vector<std::size_t> edges;
  std::size_t edge = 0;
};

struct DepthFirst {
  std::vector<std::uint32_t> finished;  // every vertex after all it leads to, but for circles
  /// The edges (from, to) that close circles: without them the graph has none.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> closing;
  std::vector<Circle> circles;  // of the first few closing edges
};

/// Linear in the graph, plus the lengths of the circles written out (at most `circle_limit`).
DepthFirst search_depth_first(const Graph& graph, std::size_t circle_limit);

}  // namespace parallax::compiler
