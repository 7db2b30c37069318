#include "compiler/plan/plan_repeats.h"

#include <map>
#include <string>
#include <tuple>

namespace parallax::compiler {
namespace {

/// The locations that control can come to from `start`.
class Reach {
 public:
  Reach(const PlanGraph& graph, const PlanTarget& start)
      : locations(graph.locations.size(), false), branches_(graph.branches.size(), false) {
    open_ = {start};
    while (!open_.empty()) {
      const auto target = open_.back();
      open_.pop_back();
      ++visits;
      if (const auto* location = std::get_if<LocationId>(&target)) {
        if (locations[location->index()]) continue;
        locations[location->index()] = true;
        open_.push_back(graph.locations[*location].on_success);
        open_.push_back(graph.locations[*location].on_failure);
      } else if (const auto* branch = std::get_if<BranchId>(&target)) {
        if (branches_[branch->index()]) continue;
        branches_[branch->index()] = true;
        open_.push_back(graph.branches[*branch].if_true);
        open_.push_back(graph.branches[*branch].if_false);
      }
    }
  }

  std::vector<bool> locations;
  std::size_t visits = 0;

 private:
  std::vector<bool> branches_;
  std::vector<PlanTarget> open_;
};

}  // namespace

std::vector<std::vector<LocationId>> earlier_attempts(const PlanGraph& graph,
                                                      std::size_t max_visits) {
  using Attempt = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, FormulaTree>;
  std::map<Attempt, std::vector<LocationId>> attempts;
  for (std::size_t i = 0; i < graph.locations.size(); ++i) {
    const auto id = graph.locations.id_at(i);
    const auto& location = graph.locations[id];
    attempts[{location.source.file.index(), location.source.begin, location.source.end,
              location.event}]
        .push_back(id);
  }
  std::vector<std::vector<LocationId>> earlier(graph.locations.size());
  std::size_t visits = 0;
  for (const auto& [attempt, ids] : attempts) {
    for (const auto id : ids) {
      if (visits > max_visits) return earlier;
      const Reach reach(graph, graph.locations[id].on_failure);
      visits += reach.visits;
      for (const auto later : ids) {
        if (reach.locations[later.index()]) earlier[later.index()].push_back(id);
      }
    }
  }
  return earlier;
}

}  // namespace parallax::compiler
