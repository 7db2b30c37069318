// Finds the parts of a plan that a trace has gone through.
//
// A trace names the performs and how they ended, but not the branches between them. All ways of
// the graph from one perform to the next are listed, guards that the trace decides taking one
// side only; the decisions that all of these ways share are certain, and only they count as
// covered. A handler is covered by a failed perform that it takes up, a retry by a perform
// behind the failure of the same form and event. Cost: the ways between two performs, of which
// at most 256 are looked at; beyond that nothing counts.

#include "tools/app/coverage_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace parallax::tools {
namespace {

using compiler::FormulaNode;
using compiler::FormulaTree;
using compiler::LeafKind;
using compiler::LocationId;
using compiler::NodeKind;
using compiler::Operator;
using compiler::PlanBranch;
using compiler::PlanLocation;
using compiler::PlanTarget;

// Limit on the different ways between two performs that are examined.
constexpr std::size_t kMaxWays = 256;

/// A formula of a plan at one timepoint of a trace. Formulas are made for people to write in a
/// binding table: recursion is as deep as they nest.
class GuardValue {
 public:
  GuardValue(const FormulaTree& guard, const compiler::PlanGraph& graph,
             const compiler::TypedModel& model, const runtime::Trace& trace, std::size_t t)
      : guard_(guard), graph_(graph), model_(model), trace_(trace), t_(t) {}

  std::optional<bool> value() const {
    if (guard_.nodes.empty()) return std::nullopt;
    return value(guard_.nodes.back());
  }

 private:
  std::optional<bool> value(const FormulaNode& node) const {
    const auto part = [&](std::size_t i) { return value(guard_.nodes[node.children[i]]); };
    if (node.kind == NodeKind::kApply) return holds(node);
    if (node.kind == NodeKind::kUnary) {
      const auto inner = part(0);
      return inner ? std::optional(!*inner) : std::nullopt;
    }
    if (node.kind != NodeKind::kBinary) return std::nullopt;
    if (node.op == Operator::kEqual || node.op == Operator::kNotEqual) {
      const auto left = term(guard_.nodes[node.children[0]]);
      const auto right = term(guard_.nodes[node.children[1]]);
      if (!left || !right) return std::nullopt;
      return (*left == *right) == (node.op == Operator::kEqual);
    }
    if (node.op == Operator::kAnd || node.op == Operator::kOr) {
      const bool decides = node.op == Operator::kOr;  // one part that is so settles it
      bool known = true;
      for (std::size_t i = 0; i < node.children.size(); ++i) {
        const auto inner = part(i);
        if (inner == decides) return decides;
        known = known && inner.has_value();
      }
      return known ? std::optional(!decides) : std::nullopt;
    }
    if (node.op != Operator::kImplies && node.op != Operator::kIff) return std::nullopt;
    const auto left = part(0), right = part(1);
    if (node.op == Operator::kImplies && (left == false || right == true)) return true;
    if (!left || !right) return std::nullopt;
    return node.op == Operator::kIff ? *left == *right : false;
  }

  /// A fluent, as formulas of a plan write it: `RobotAt(r2)`.
  std::optional<bool> holds(const FormulaNode& node) const {
    const auto symbol = model_.find_symbol(guard_.name(node));
    if (!symbol || model_.symbols[*symbol].kind != compiler::SymbolKind::kFluent) {
      return std::nullopt;
    }
    const auto text = term(node);
    if (!text) return std::nullopt;
    const auto names = trace_.holds(t_);
    return std::binary_search(names.begin(), names.end(), std::string_view(*text));
  }

  /// As it is printed; none if it is no term without variables and arithmetic.
  std::optional<std::string> term(const FormulaNode& node) const {
    if (node.kind == NodeKind::kName && node.leaf == LeafKind::kName) {
      return std::string(guard_.name(node));
    }
    if (node.kind == NodeKind::kNumber) return std::string(guard_.name(node));
    if (node.kind == NodeKind::kName && node.leaf == LeafKind::kRegister) {
      const auto& registers = trace_.points[t_].registers;
      const auto& name = graph_.values[graph_.values.id_at(node.number)].name;
      const auto found = registers.find(name);
      return found == registers.end() ? std::nullopt : std::optional(found->second);
    }
    if (node.kind != NodeKind::kApply) return std::nullopt;
    std::vector<std::string> arguments;
    for (const auto child : node.children) {
      auto argument = term(guard_.nodes[child]);
      if (!argument) return std::nullopt;
      arguments.push_back(*std::move(argument));
    }
    return fmt::format("{}({})", guard_.name(node), fmt::join(arguments, ","));
  }

  const FormulaTree& guard_;
  const compiler::PlanGraph& graph_;
  const compiler::TypedModel& model_;
  const runtime::Trace& trace_;
  std::size_t t_;
};

}  // namespace

CoverageKey coverage_key(CoverageGroup group, const base::SourceRange& source, std::string id,
                         const base::SourceFiles& files) {
  const auto& file = files[source.file];
  const auto at = file.position(source.begin);
  return {group, file.name(), at.line, at.column, std::move(id)};
}

PlanCoverage::PlanCoverage(const compiler::PlanGraph& graph, const compiler::TypedModel& model,
                           const base::SourceFiles& files)
    : graph_(graph), model_(model), files_(files), earlier_(compiler::earlier_attempts(graph)) {
  for (std::size_t i = 0; i < graph.locations.size(); ++i) {
    const auto& location = graph.locations[graph.locations.id_at(i)];
    all_.insert(perform(location));
    outcomes_.insert(outcome(location, true));
    outcomes_.insert(outcome(location, false));
    if (!earlier_[i].empty()) all_.insert(retry(location));
  }
  for (std::size_t i = 0; i < graph.branches.size(); ++i) {
    const auto& branch = graph.branches[graph.branches.id_at(i)];
    all_.insert(decision(branch, true));
    all_.insert(decision(branch, false));
  }
  for (const auto& one : graph.handlers) {
    all_.insert(handler(one));
    if (one.failures.empty()) without_performs_.insert(handler(one));
  }
  for (const auto& one : graph.handlers) {
    if (!one.failures.empty()) without_performs_.erase(handler(one));
  }
  all_.insert(outcomes_.begin(), outcomes_.end());
}

CoverageKey PlanCoverage::perform(const PlanLocation& location) const {
  return coverage_key(CoverageGroup::kPerforms, location.source, location.event_symbol, files_);
}

CoverageKey PlanCoverage::outcome(const PlanLocation& location, bool success) const {
  return coverage_key(CoverageGroup::kBranches, location.source,
                      fmt::format("{} {}", location.event_symbol, success ? "succeeds" : "fails"),
                      files_);
}

CoverageKey PlanCoverage::retry(const PlanLocation& location) const {
  return coverage_key(CoverageGroup::kRetries, location.source, location.event_symbol + " again",
                      files_);
}

CoverageKey PlanCoverage::decision(const PlanBranch& branch, bool value) const {
  return coverage_key(CoverageGroup::kBranches, branch.source,
                      fmt::format("{}: {}", branch.text(), value), files_);
}

CoverageKey PlanCoverage::handler(const compiler::PlanHandler& handler) const {
  return coverage_key(CoverageGroup::kHandlers, handler.source,
                      fmt::format("{}", fmt::join(handler.failure_classes, " or ")), files_);
}

std::optional<bool> PlanCoverage::value(const FormulaTree& guard, const runtime::Trace& trace,
                                        std::size_t t) const {
  return GuardValue(guard, graph_, model_, trace, t).value();
}

void PlanCoverage::add_ways(const PlanTarget& from, std::optional<LocationId> next,
                            const runtime::Trace& trace, std::size_t t, std::vector<Decision>& path,
                            std::vector<std::set<Decision>>& found) const {
  if (found.size() >= kMaxWays) return;
  const auto* id = std::get_if<compiler::BranchId>(&from);
  if (id == nullptr) {
    // At the end of a trace nothing tells where control is.
    const auto* location = std::get_if<LocationId>(&from);
    if (next && (location == nullptr || *location != *next)) return;
    found.emplace_back(path.begin(), path.end());
    return;
  }
  // No cycle consists of branches alone, so this ends.
  const auto& branch = graph_.branches[*id];
  const auto known = branch.free ? std::nullopt : value(branch.guard, trace, t);
  for (const bool side : {true, false}) {
    if (known && *known != side) continue;
    path.emplace_back(*id, side);
    add_ways(side ? branch.if_true : branch.if_false, next, trace, t, path, found);
    path.pop_back();
  }
}

std::set<PlanCoverage::Decision> PlanCoverage::way(const PlanTarget& from,
                                                   std::optional<LocationId> next,
                                                   const runtime::Trace& trace,
                                                   std::size_t t) const {
  std::vector<Decision> path;
  std::vector<std::set<Decision>> found;
  add_ways(from, next, trace, t, path, found);
  if (found.empty() || found.size() >= kMaxWays) return {};
  auto certain = found.front();
  for (const auto& other : found) {
    std::erase_if(certain, [&](const Decision& decision) { return !other.contains(decision); });
  }
  return certain;
}

PlanPath PlanCoverage::path_of(const runtime::Trace& trace) const {
  PlanPath path;
  const auto step = [&](std::size_t t) -> std::optional<LocationId> {
    if (t + 1 >= trace.points.size() || !trace.points[t].plan_step) return std::nullopt;
    return graph_.locations.id_at(*trace.points[t].plan_step);
  };
  const auto follow = [&](const PlanTarget& from, std::size_t t) {
    const auto decisions = way(from, step(t), trace, t);
    path.decisions.insert(path.decisions.end(), decisions.begin(), decisions.end());
  };
  follow(graph_.entry, 0);
  for (std::size_t t = 0; step(t); ++t) {
    const auto& location = graph_.locations[*step(t)];
    const bool success = trace.points[t].succeeded;
    path.steps.push_back({*step(t), success});
    follow(success ? location.on_success : location.on_failure, t + 1);
  }
  return path;
}

std::set<CoverageKey> PlanCoverage::covered_by(const PlanPath& path) const {
  std::set<CoverageKey> covered;
  for (const auto& [branch, side] : path.decisions) {
    covered.insert(decision(graph_.branches[branch], side));
  }
  std::set<LocationId> failed;
  for (const auto& step : path.steps) {
    const auto id = step.location;
    const auto& location = graph_.locations[id];
    covered.insert(perform(location));
    covered.insert(outcome(location, step.succeeded));
    const auto& earlier = earlier_[id.index()];
    if (std::any_of(earlier.begin(), earlier.end(),
                    [&](LocationId other) { return failed.contains(other); })) {
      covered.insert(retry(location));
    }
    if (step.succeeded) continue;
    failed.insert(id);
    for (const auto& one : graph_.handlers) {
      const bool takes =
          step.way ? std::binary_search(one.ways.begin(), one.ways.end(), std::pair(id, *step.way))
                   : std::binary_search(one.failures.begin(), one.failures.end(), id);
      if (takes) covered.insert(handler(one));
    }
  }
  return covered;
}

}  // namespace parallax::tools
