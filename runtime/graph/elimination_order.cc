// An elimination order by least degree (Markowitz 1957).
//
// Repeatedly the vertex with the fewest neighbours is removed and its neighbours are connected
// with each other. The order stands for a tree decomposition whose width is the largest number
// of neighbours at a removal; the least width is hard to find, and least degree is a usual
// heuristic for it. Vertices of a lower stage go first, so that hidden variables are eliminated
// before those that tell traces apart. Neighbours are sorted lists; the next vertex comes from
// an ordered set.
//
// Cost: for each removal the square of its neighbours, times the length of a list for an
// insertion; edges made on the way are limited.

#include "runtime/graph/elimination_order.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace parallax::runtime {
namespace {

using Vertex = std::uint32_t;

bool insert_sorted(std::vector<Vertex>& set, Vertex vertex) {
  const auto at = std::lower_bound(set.begin(), set.end(), vertex);
  if (at != set.end() && *at == vertex) return false;
  set.insert(at, vertex);
  return true;
}

void erase_sorted(std::vector<Vertex>& set, Vertex vertex) {
  const auto at = std::lower_bound(set.begin(), set.end(), vertex);
  if (at != set.end() && *at == vertex) set.erase(at);
}

}  // namespace

std::optional<std::vector<std::uint32_t>> elimination_order(
    std::size_t vertices, std::span<const std::vector<std::uint32_t>> cliques,
    std::span<const std::uint8_t> stage, std::size_t most_edges) {
  std::vector<std::vector<Vertex>> neighbours(vertices);
  std::size_t edges = 0;
  const auto connect = [&](const std::vector<Vertex>& clique) {
    for (const auto a : clique) {
      for (const auto b : clique) {
        if (a != b && insert_sorted(neighbours[a], b)) ++edges;
      }
      if (edges > most_edges) return false;
    }
    return true;
  };
  for (const auto& clique : cliques) {
    if (!connect(clique)) return std::nullopt;
  }
  using Entry = std::tuple<std::uint8_t, std::size_t, Vertex>;
  std::set<Entry> queue;
  const auto entry = [&](Vertex v) {
    return Entry{stage[v], neighbours[v].size(), static_cast<Vertex>(vertices) - v};
  };
  for (Vertex v = 0; v < vertices; ++v) queue.insert(entry(v));
  std::vector<std::uint32_t> order;
  order.reserve(vertices);
  while (!queue.empty()) {
    const auto v = static_cast<Vertex>(vertices) - std::get<Vertex>(*queue.begin());
    queue.erase(queue.begin());
    order.push_back(v);
    const auto around = std::move(neighbours[v]);
    for (const auto u : around) queue.erase(entry(u));
    for (const auto u : around) erase_sorted(neighbours[u], v);
    if (!connect(around)) return std::nullopt;
    for (const auto u : around) queue.insert(entry(u));
  }
  return order;
}

}  // namespace parallax::runtime
