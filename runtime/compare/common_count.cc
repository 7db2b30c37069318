#include "runtime/compare/common_count.h"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace parallax::runtime {
namespace {

using compiler::CompiledModel;
using compiler::GroundName;
using NodePair = std::pair<std::uint32_t, std::uint32_t>;

/// For every bit of a graph's vectors its number among the names of all.
class BitNames {
 public:
  BitNames(const std::vector<GroundName>& names,
           const std::map<std::string_view, std::uint32_t>& all) {
    for (const auto& name : names) {
      if (name.slot) numbers_.push_back(all.at(name.name));
    }
  }
  std::vector<std::uint32_t> true_names(const Bits& bits) const {
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      if (bits[i]) out.push_back(numbers_[i]);
    }
    std::sort(out.begin(), out.end());
    return out;
  }

 private:
  std::vector<std::uint32_t> numbers_;
};

std::map<std::string_view, std::uint32_t> numbered(const std::vector<GroundName>& names) {
  std::map<std::string_view, std::uint32_t> out;
  for (const auto& name : names) out.emplace(name.name, static_cast<std::uint32_t>(out.size()));
  return out;
}

/// One graph with states and events in the numbers of both.
class Side {
 public:
  Side(const TraceGraph& graph, const CompiledModel& model,
       const std::map<std::string_view, std::uint32_t>& fluents,
       const std::map<std::string_view, std::uint32_t>& events)
      : graph_(graph), fluents_(model.fluents, fluents), events_(model.events, events) {}

  using Label = std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>>;
  const TraceGraph& graph() const { return graph_; }
  std::vector<std::uint32_t> state(std::uint32_t node) const {
    return fluents_.true_names(graph_.node(node).observed);
  }
  /// What happens and what holds after it; each label leads to one node.
  Label label(const GraphEdge& edge) const {
    return {events_.true_names(graph_.events(edge.events)), state(edge.target)};
  }

 private:
  const TraceGraph& graph_;
  BitNames fluents_, events_;
};

/// Pairs of nodes that are reached by the same observations, layer by layer; then counted back.
class CommonPaths {
 public:
  CommonPaths(const Side& first, const Side& second) : first_(first), second_(second) {}

  mpz_class count() {
    const auto horizon = first_.graph().model().horizon;
    std::vector<std::map<NodePair, std::vector<NodePair>>> layers;
    layers.emplace_back();
    for (const auto& pair : starts()) layers.back()[pair];
    for (Timepoint t = 0; t < horizon; ++t) {
      std::map<NodePair, std::vector<NodePair>> next;
      for (auto& [pair, ways] : layers.back()) {
        ways = common_ways(t, pair);
        for (const auto& way : ways) next[way];
      }
      layers.push_back(std::move(next));
    }
    std::map<NodePair, mpz_class> counts;
    for (const auto& [pair, ways] : layers.back()) counts[pair] = is_live(horizon, pair) ? 1 : 0;
    for (Timepoint t = horizon; t-- > 0;) {
      std::map<NodePair, mpz_class> before;
      for (const auto& [pair, ways] : layers[static_cast<std::size_t>(t)]) {
        auto& sum = before[pair];
        for (const auto& way : ways) sum += counts[way];
      }
      counts = std::move(before);
    }
    mpz_class total;
    for (const auto& [pair, count] : counts) total += count;
    return total;
  }

 private:
  bool is_live(Timepoint t, const NodePair& pair) const {
    return first_.graph().completions(t, pair.first) != 0 &&
           second_.graph().completions(t, pair.second) != 0;
  }

  std::vector<NodePair> starts() const {
    std::map<std::vector<std::uint32_t>, std::uint32_t> others;
    for (const auto node : second_.graph().starts()) others.emplace(second_.state(node), node);
    std::vector<NodePair> out;
    for (const auto node : first_.graph().starts()) {
      const auto found = others.find(first_.state(node));
      if (found != others.end() && is_live(0, {node, found->second})) {
        out.emplace_back(node, found->second);
      }
    }
    return out;
  }

  std::vector<NodePair> common_ways(Timepoint t, const NodePair& from) const {
    std::map<Side::Label, std::uint32_t> others;
    for (const auto& edge : second_.graph().edges(t, from.second)) {
      others.emplace(second_.label(edge), edge.target);
    }
    std::vector<NodePair> out;
    for (const auto& edge : first_.graph().edges(t, from.first)) {
      const auto found = others.find(first_.label(edge));
      if (found == others.end()) continue;
      const NodePair way{edge.target, found->second};
      if (is_live(t + 1, way)) out.push_back(way);
    }
    return out;
  }

  const Side& first_;
  const Side& second_;
};

}  // namespace

mpz_class count_common(const TraceGraph& first, const CompiledModel& first_model,
                       const TraceGraph& second, const CompiledModel& second_model) {
  const auto fluents = numbered(first_model.fluents), events = numbered(first_model.events);
  const Side a(first, first_model, fluents, events), b(second, second_model, fluents, events);
  return CommonPaths(a, b).count();
}

}  // namespace parallax::runtime
