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

  /// Strongly connected components, each after those that it needs (Tarjan
  /// 1972).
  void find_components() {
    constexpr std::size_t kNew = SIZE_MAX;
    const auto count = needs_.size();
    std::vector<std::size_t> index(count, kNew), low(count, 0);
    std::vector<std::size_t> path;
    component_of_.assign(count, kNew);
    struct Visit {
      std::size_t unknown, next;
    };
    std::size_t met = 0;
    for (std::size_t root = 0; root < count; ++root) {
      if (index[root] != kNew) continue;
      std::vector<Visit> stack = {{root, 0}};
      while (!stack.empty()) {
        auto& [unknown, next] = stack.back();
        if (next == 0) {
          index[unknown] = low[unknown] = met++;
          path.push_back(unknown);
        }
        if (next < needs_[unknown].size()) {
          const auto other = needs_[unknown][next++].unknown;
          if (index[other] == kNew) {
            stack.push_back({other, 0});
          } else if (component_of_[other] == kNew) {
            low[unknown] = std::min(low[unknown], index[other]);
          }
          continue;
        }
        const auto done = unknown;
        stack.pop_back();
        if (!stack.empty()) {
          auto& above = low[stack.back().unknown];
          above = std::min(above, low[done]);
        }
        if (low[done] != index[done]) continue;
        auto& component = components_.emplace_back();
        std::size_t member = kNew;
        do {
          member = path.back();
          path.pop_back();
          component_of_[member] = components_.size() - 1;
          component.push_back(member);
        } while (member != done);
        std::sort(component.begin(), component.end());
      }
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
