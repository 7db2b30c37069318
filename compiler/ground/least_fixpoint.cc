// Least solution of a system of equations between truth values and formulas.
//
// Unknowns that need each other form the strongly connected components of the graph of needs
// (Tarjan 1972); each component is solved after those that it needs. If a need inside a
// component is negated the system is not stratified and has no least solution: the shortest way
// back, found breadth first, is reported as a cycle. Else the definitions are monotone in the
// component's unknowns. All start as false and are replaced by their definitions, round by
// round. A round that changes anything makes one more of n unknowns true under some valuation,
// so n rounds reach the least fixpoint.
//
// Cost: the components are linear in the needs. A component of n unknowns takes at most n rounds
// of n rewrites; formulas may grow, and the number of new nodes is limited.

#include "compiler/ground/least_fixpoint.h"

#include <algorithm>
#include <deque>
#include <unordered_map>

#include "compiler/ground/components.h"

namespace parallax::compiler {
namespace {

struct Need {
  std::size_t unknown = 0;
  bool negated = false;
};

class FixpointSolver {
 public:
  FixpointSolver(FormulaStore& formulas, const FixpointSystem& system, std::size_t max_nodes)
      : formulas_(formulas), system_(system), most_nodes_(formulas.node_count() + max_nodes) {
    for (const auto definition : system.definitions) needs_.push_back(needs_of(definition));
    solution_.assign(system.definitions.size(), formulas.falsity());
  }

  FixpointResult run() {
    find_components();
    for (const auto& component : components_) {
      if (const auto cycle = cycle_through_negation(component)) return *cycle;
      if (!solve(component)) return FixpointTooLarge{};
    }
    return std::move(solution_);
  }

 private:
  /// Each once; an unknown may be needed both ways.
  std::vector<Need> needs_of(FormulaId definition) const {
    std::vector<Need> needs;
    for (const bool negated : {false, true}) {
      std::vector<std::size_t> unknowns;
      for (const auto variable : positive_atoms(formulas_, negated ? ~definition : definition)) {
        const auto found = system_.unknown_of.find(variable);
        if (found != system_.unknown_of.end()) unknowns.push_back(found->second);
      }
      std::sort(unknowns.begin(), unknowns.end());
      unknowns.erase(std::unique(unknowns.begin(), unknowns.end()), unknowns.end());
      for (const auto unknown : unknowns) needs.push_back({unknown, negated});
    }
    return needs;
  }

  void find_components() {
    std::vector<std::vector<std::size_t>> graph;
    for (const auto& needs : needs_) {
      auto& unknowns = graph.emplace_back();
      for (const auto& need : needs) unknowns.push_back(need.unknown);
    }
    components_ = strong_components(graph);
    component_of_.resize(graph.size());
    for (std::size_t c = 0; c < components_.size(); ++c) {
      for (const auto member : components_[c]) component_of_[member] = c;
    }
  }

  bool inside(std::size_t unknown, std::size_t other) const {
    return component_of_[unknown] == component_of_[other];
  }

  /// The shortest way back from the first negated need that stays in the
  /// component.
  std::optional<FixpointCycle> cycle_through_negation(
      const std::vector<std::size_t>& component) const {
    for (const auto unknown : component) {
      for (const auto& need : needs_[unknown]) {
        if (!need.negated || !inside(unknown, need.unknown)) continue;
        FixpointCycle cycle;
        cycle.path.push_back({unknown, true});
        append_way(need.unknown, unknown, cycle);
        return cycle;
      }
    }
    return std::nullopt;
  }

  void append_way(std::size_t from, std::size_t to, FixpointCycle& cycle) const {
    std::unordered_map<std::size_t, Need> next;  // towards `to`, with the sign of the need
    std::deque<std::size_t> todo = {to};
    // Backwards from the goal, so that the way can be read off forwards.
    std::unordered_map<std::size_t, std::vector<Need>> needed_by;
    for (const auto member : components_[component_of_[to]]) {
      for (const auto& need : needs_[member]) {
        if (inside(member, need.unknown)) needed_by[need.unknown].push_back({member, need.negated});
      }
    }
    while (!todo.empty() && !next.contains(from)) {
      const auto reached = todo.front();
      todo.pop_front();
      for (const auto& by : needed_by[reached]) {
        if (by.unknown == to || !next.emplace(by.unknown, Need{reached, by.negated}).second) {
          continue;
        }
        todo.push_back(by.unknown);
      }
    }
    for (auto at = from; at != to; at = next.at(at).unknown) {
      cycle.path.push_back({at, next.at(at).negated});
    }
  }

  /// Every round that changes anything makes one more of n unknowns true
  /// somewhere, so n are enough.
  bool solve(const std::vector<std::size_t>& component) {
    for (std::size_t round = 0; round < component.size(); ++round) {
      bool changed = false;
      for (const auto unknown : component) {
        RewriteMemo memo;  // not kept: solutions of the component change
        const auto value = rewrite_atoms(
            formulas_, system_.definitions[unknown],
            [&](std::int32_t variable) {
              const auto found = system_.unknown_of.find(variable);
              return found == system_.unknown_of.end() ? formulas_.atom(variable)
                                                       : solution_[found->second];
            },
            memo);
        changed = changed || value != solution_[unknown];
        solution_[unknown] = value;
        if (formulas_.node_count() > most_nodes_) return false;
      }
      if (!changed) break;
    }
    return true;
  }

  FormulaStore& formulas_;
  const FixpointSystem& system_;
  const std::size_t most_nodes_;
  std::vector<std::vector<Need>> needs_;  // by unknown
  std::vector<std::vector<std::size_t>> components_;
  std::vector<std::size_t> component_of_;  // by unknown
  std::vector<FormulaId> solution_;
};

}  // namespace

FixpointResult least_fixpoint(FormulaStore& formulas, const FixpointSystem& system,
                              std::size_t max_nodes) {
  return FixpointSolver(formulas, system, max_nodes).run();
}

}  // namespace parallax::compiler
