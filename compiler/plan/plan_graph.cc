// Searches on the graph of a plan, and its text.
//
// Shortest way: breadth first by layers of performs; branches cost nothing, so their targets
// join the present layer. Longest way: depth first, a node being finished after all its
// successors; a successor that is still open is a cycle, and then there is none. Registers that
// the rest of the plan reads: the least fixed point backwards, what a place reads itself and
// what its successors need, less what a perform binds when it succeeds. Earlier attempts: for
// each perform form and event, the places that can be reached behind the failure of one of its
// locations; if the same perform is among them it repeats that attempt.
//
// Cost: ways are linear in the graph, registers take hardly more than three rounds; attempts
// take one search for each location and are limited in visits.

#include "compiler/plan/plan_graph.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>

#include "compiler/base/shown_text.h"

namespace parallax::compiler {
namespace {

std::string argument_text(const PlanGraph& graph, const PlanArgument& argument) {
  if (const auto* id = std::get_if<ModelValueId>(&argument)) return graph.values[*id].name;
  if (const auto* text = std::get_if<std::string>(&argument)) return *text;
  if (const auto* integer = std::get_if<std::int64_t>(&argument))
    return fmt::format("{}", *integer);
  return fmt::format("{}", std::get<double>(argument));
}

std::string terminal_text(const PlanTerminal& terminal, const base::SourceFiles& files) {
  switch (terminal.kind) {
    case TerminalKind::kDone:
      return "DONE";
    case TerminalKind::kFailed:
      return fmt::format("FAILED({})", terminal.detail);
    case TerminalKind::kNever:
      return "NEVER";
    case TerminalKind::kBound:
      return terminal.source
                 ? fmt::format("BOUND({} at {})", terminal.detail, files.place(*terminal.source))
                 : fmt::format("BOUND({})", terminal.detail);
  }
  return {};
}

/// A label in double quotes for Graphviz.
std::string dot_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : base::printable(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// Nodes for the search below: locations, then branches, then terminals.
std::size_t node_of(const PlanGraph& graph, const PlanTarget& target) {
  if (const auto* location = std::get_if<LocationId>(&target)) return location->index();
  if (const auto* branch = std::get_if<BranchId>(&target)) {
    return graph.locations.size() + branch->index();
  }
  return graph.locations.size() + graph.branches.size() + std::get<TerminalId>(target).index();
}

std::vector<PlanTarget> successors(const PlanGraph& graph, std::size_t node) {
  if (node < graph.locations.size()) {
    const auto& location = graph.locations[graph.locations.id_at(node)];
    return {location.on_success, location.on_failure};
  }
  node -= graph.locations.size();
  if (node < graph.branches.size()) {
    const auto& branch = graph.branches[graph.branches.id_at(node)];
    return {branch.if_true, branch.if_false};
  }
  return {};
}

/// Adds `more`; true if that was news.
bool include(RegisterSet& set, const RegisterSet& more) {
  const auto before = set.size();
  set.insert(more.begin(), more.end());
  return set.size() != before;
}

RegisterSet read_by(const PlanLocation& location) {
  auto out = registers_in(location.event);
  include(out, registers_in(location.success.formula));
  for (const auto& [name, value] : location.arguments) {
    if (const auto* id = std::get_if<ModelValueId>(&value)) out.insert(*id);
  }
  return out;
}

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

PlanTarget failure_target(const PlanGraph& graph, const PlanLocation& location, std::size_t way) {
  auto target = location.on_failure;
  for (std::size_t i = 0; i + 1 < location.failures.size(); ++i) {
    const auto& branch = graph.branches[std::get<BranchId>(target)];
    if (i == way) return branch.if_true;
    target = branch.if_false;
  }
  return target;
}

std::vector<PlanDecision> decisions_of_way(const PlanGraph& graph, const PlanLocation& location,
                                           std::size_t way) {
  std::vector<PlanDecision> out;
  auto target = location.on_failure;
  for (std::size_t i = 0; i <= way && i + 1 < location.failures.size(); ++i) {
    out.emplace_back(std::get<BranchId>(target), i == way);
    target = graph.branches[out.back().first].if_false;
  }
  return out;
}

std::string to_string(const PlanGraph& graph, const PlanTarget& target,
                      const base::SourceFiles& files) {
  if (const auto* location = std::get_if<LocationId>(&target)) {
    return fmt::format("L{}", location->index());
  }
  if (const auto* branch = std::get_if<BranchId>(&target)) {
    return fmt::format("B{}", branch->index());
  }
  return terminal_text(graph.terminals[std::get<TerminalId>(target)], files);
}

std::string dump_text(const PlanGraph& graph, const base::SourceFiles& files) {
  std::string out = fmt::format("entry {}\n", to_string(graph, graph.entry, files));
  for (std::size_t i = 0; i < graph.locations.size(); ++i) {
    const auto& location = graph.locations[graph.locations.id_at(i)];
    out += fmt::format("L{} {} at {}\n", i, location.event.text, files.place(location.source));
    for (const auto& call : location.calls) {
      out += fmt::format("  called at {}\n", files.place(call));
    }
    out += fmt::format("  ok: {} @t{}\n", location.success.formula.text,
                       location.success.time_offset == 0 ? "" : "+1");
    for (const auto& [name, value] : location.arguments) {
      out += fmt::format("  {} = {}\n", name, argument_text(graph, value));
    }
    if (location.result) {
      out += fmt::format("  returns {}\n", graph.values[*location.result].name);
    }
    out += fmt::format("  success -> {}\n", to_string(graph, location.on_success, files));
    out += fmt::format("  {} -> {}\n", location.failure_class,
                       to_string(graph, location.on_failure, files));
  }
  for (std::size_t i = 0; i < graph.branches.size(); ++i) {
    const auto& branch = graph.branches[graph.branches.id_at(i)];
    out += fmt::format("B{} {}{} at {}\n  true -> {}\n  false -> {}\n", i,
                       branch.free ? "free: " : "", branch.text(), files.place(branch.source),
                       to_string(graph, branch.if_true, files),
                       to_string(graph, branch.if_false, files));
  }
  return out;
}

std::string dump_dot(const PlanGraph& graph, const base::SourceFiles& files) {
  const auto name = [&](const PlanTarget& target) {
    const auto* terminal = std::get_if<TerminalId>(&target);
    return terminal != nullptr ? fmt::format("T{}", terminal->index())
                               : to_string(graph, target, files);
  };
  std::string out = "digraph plan {\n  node [shape=box];\n  start [shape=point];\n";
  for (std::size_t i = 0; i < graph.locations.size(); ++i) {
    const auto& location = graph.locations[graph.locations.id_at(i)];
    out += fmt::format("  L{} [label={}];\n", i,
                       dot_text(location.event.text + " at " + files.place(location.source)));
  }
  for (std::size_t i = 0; i < graph.branches.size(); ++i) {
    const auto& branch = graph.branches[graph.branches.id_at(i)];
    out += fmt::format("  B{} [shape=diamond, label={}];\n", i, dot_text(branch.text()));
  }
  for (std::size_t i = 0; i < graph.terminals.size(); ++i) {
    const auto& terminal = graph.terminals[graph.terminals.id_at(i)];
    out +=
        fmt::format("  T{} [shape=oval, label={}];\n", i, dot_text(terminal_text(terminal, files)));
  }
  out += fmt::format("  start -> {};\n", name(graph.entry));
  for (std::size_t i = 0; i < graph.locations.size(); ++i) {
    const auto& location = graph.locations[graph.locations.id_at(i)];
    out += fmt::format("  L{} -> {};\n", i, name(location.on_success));
    out += fmt::format("  L{} -> {} [style=dashed, label={}];\n", i, name(location.on_failure),
                       dot_text(location.failure_class));
  }
  for (std::size_t i = 0; i < graph.branches.size(); ++i) {
    const auto& branch = graph.branches[graph.branches.id_at(i)];
    out += fmt::format("  B{} -> {} [label=true];\n", i, name(branch.if_true));
    out += fmt::format("  B{} -> {} [label=false];\n", i, name(branch.if_false));
  }
  return out + "}\n";
}

std::optional<std::int64_t> shortest_path(const PlanGraph& graph) {
  const auto count = graph.locations.size() + graph.branches.size() + graph.terminals.size();
  std::vector<bool> seen(count, false);
  // Branches cost nothing: their targets join the present layer.
  std::vector<std::size_t> layer = {node_of(graph, graph.entry)}, next;
  for (std::int64_t performs = 0; !layer.empty(); ++performs) {
    next.clear();
    while (!layer.empty()) {
      const auto node = layer.back();
      layer.pop_back();
      if (seen[node]) continue;
      seen[node] = true;
      const auto first_terminal = graph.locations.size() + graph.branches.size();
      if (node >= first_terminal) {
        const TerminalId terminal(static_cast<std::uint32_t>(node - first_terminal));
        if (graph.terminals[terminal].kind == TerminalKind::kDone) return performs;
      }
      for (const auto& target : successors(graph, node)) {
        auto& where = node < graph.locations.size() ? next : layer;
        where.push_back(node_of(graph, target));
      }
    }
    std::swap(layer, next);
  }
  return std::nullopt;
}

std::optional<std::int64_t> longest_path(const PlanGraph& graph) {
  constexpr std::int64_t kUnseen = -2;
  constexpr std::int64_t kOpen = -1;
  const auto count = graph.locations.size() + graph.branches.size() + graph.terminals.size();
  std::vector<std::int64_t> longest(count, kUnseen);
  // Depth first without recursion: a node is finished once all its successors are.
  std::vector<std::size_t> open = {node_of(graph, graph.entry)};
  while (!open.empty()) {
    const auto node = open.back();
    const bool first = longest[node] == kUnseen;
    if (!first && longest[node] != kOpen) {
      open.pop_back();
      continue;
    }
    std::int64_t best = 0;
    const auto next = successors(graph, node);
    for (const auto& target : next) {
      const auto index = node_of(graph, target);
      if (longest[index] == kOpen && first) return std::nullopt;
      if (longest[index] == kUnseen) open.push_back(index);
      best = std::max(best, longest[index]);
    }
    if (first) {
      longest[node] = kOpen;
      // A location that comes straight back to itself was not open yet when it was looked at.
      for (const auto& target : next) {
        if (node_of(graph, target) == node) return std::nullopt;
      }
      continue;
    }
    longest[node] = best + (node < graph.locations.size() ? 1 : 0);
    open.pop_back();
  }
  return longest[node_of(graph, graph.entry)];
}

const RegisterSet& PlanLiveness::at(const PlanTarget& target) const {
  static const RegisterSet kNone;
  if (const auto* location = std::get_if<LocationId>(&target)) return locations[location->index()];
  if (const auto* branch = std::get_if<BranchId>(&target)) return branches[branch->index()];
  return kNone;
}

PlanLiveness plan_liveness(const PlanGraph& graph) {
  PlanLiveness out;
  for (const auto& location : graph.locations) out.locations.push_back(read_by(location));
  for (const auto& branch : graph.branches) {
    out.branches.push_back(branch.free ? RegisterSet() : registers_in(branch.guard));
  }
  for (bool changed = !graph.values.empty(); changed;) {
    changed = false;
    for (auto i = graph.branches.size(); i-- > 0;) {
      const auto& branch = graph.branches[graph.branches.id_at(i)];
      changed = include(out.branches[i], out.at(branch.if_true)) || changed;
      changed = include(out.branches[i], out.at(branch.if_false)) || changed;
    }
    for (auto i = graph.locations.size(); i-- > 0;) {
      const auto& location = graph.locations[graph.locations.id_at(i)];
      auto behind = out.at(location.on_success);
      if (location.result) behind.erase(*location.result);
      changed = include(out.locations[i], behind) || changed;
      changed = include(out.locations[i], out.at(location.on_failure)) || changed;
    }
  }
  return out;
}

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
