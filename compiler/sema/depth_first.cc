#include "compiler/sema/depth_first.h"

#include <algorithm>

namespace parallax::compiler {
namespace {

class Search {
 public:
  Search(const Graph& graph, std::size_t circle_limit)
      : graph_(graph), circle_limit_(circle_limit), state_(graph.size(), kNew) {}

  DepthFirst run() {
    for (std::uint32_t vertex = 0; vertex < graph_.size(); ++vertex) {
      if (state_[vertex] == kNew) open(vertex);
      while (!stack_.empty()) step();
    }
    return std::move(result_);
  }

 private:
  static constexpr std::uint8_t kNew = 0, kOpen = 1, kDone = 2;
  struct Visit {
    std::uint32_t vertex;
    std::size_t next;
  };

  void open(std::uint32_t vertex) {
    state_[vertex] = kOpen;
    stack_.push_back({vertex, 0});
  }

  void step() {
    Visit& top = stack_.back();
    if (top.next == graph_[top.vertex].size()) {
      state_[top.vertex] = kDone;
      result_.finished.push_back(top.vertex);
      stack_.pop_back();
      return;
    }
    const auto to = graph_[top.vertex][top.next++];
    if (state_[to] == kNew) {
      open(to);
    } else if (state_[to] == kOpen) {
      result_.closing.emplace_back(top.vertex, to);
      if (result_.circles.size() < circle_limit_) note_circle(to);
    }
  }

  void note_circle(std::uint32_t start) {
    const auto first = std::find_if(stack_.begin(), stack_.end(),
                                    [&](const Visit& visit) { return visit.vertex == start; });
    Circle circle;
    for (auto visit = first; visit != stack_.end(); ++visit) {
      circle.path.push_back(visit->vertex);
      circle.edges.push_back(visit->next - 1);
    }
    circle.edge = circle.edges.back();
    circle.edges.pop_back();
    result_.circles.push_back(std::move(circle));
  }

  const Graph& graph_;
  const std::size_t circle_limit_;
  std::vector<std::uint8_t> state_;
  std::vector<Visit> stack_;
  DepthFirst result_;
};

}  // namespace

DepthFirst search_depth_first(const Graph& graph, std::size_t circle_limit) {
  return Search(graph, circle_limit).run();
}

}  // namespace parallax::compiler
