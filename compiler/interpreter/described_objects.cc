// Performs of objects that the plan describes only: any one of those that meet the description.
#include <fmt/core.h>

#include <cstddef>
#include <utility>

#include "compiler/base/codes/plans.h"
#include "compiler/interpreter/explorer.h"

namespace parallax::compiler {

/// The same perform with the object named.
StopPerform Explorer::named(const StopPerform& stop, const PerformResolver::Reference& reference,
                            std::string_view name) {
  auto value = values_[reference.object];
  value.keys.emplace_back("name", values_.symbol(name));
  auto id = values_.intern(std::move(value));
  for (auto step = reference.path.rbegin(); step != reference.path.rend(); ++step) {
    auto outer = values_[step->first];
    outer.keys[step->second].second = id;
    id = values_.intern(std::move(outer));
  }
  return {id, stop.form};
}

/// Any one of those whose guards hold: free branches choose, and a choice that does not hold is no
/// execution.
BranchId Explorer::one_of(const std::vector<ModelWay>& ways, DatumId form,
                          const std::function<Job(std::uint32_t)>& job) {
  const auto add = [&](std::uint32_t number, Job::Edge edge, BranchId owner) {
    auto next = job(number);
    next.edge = edge;
    next.owner = owner.index();
    jobs_.push_back(std::move(next));
  };
  if (ways.size() == 1 && !ways.front().elsewhere) {
    const auto only = branch(ways.front().guard, form);
    add(0, Job::Edge::kFalse, only);
    add(1, Job::Edge::kTrue, only);
    return only;
  }
  const auto some = branch({}, form);
  add(0, Job::Edge::kFalse, some);
  const auto never = terminal(TerminalKind::kNever, {}, std::nullopt);
  std::vector<FormulaTree> guards;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    guards.push_back(ways[i].guard);
    if (!ways[i].elsewhere) open.push_back(i);
  }
  std::optional<BranchId> before;
  if (open.empty()) graph_.branches[some].if_true = never;
  for (const auto i : open) {
    const auto test = branch(ways[i].guard, form);
    graph_.branches[test].if_false = never;
    add(static_cast<std::uint32_t>(i + 1), Job::Edge::kTrue, test);
    PlanTarget here = test;
    std::optional<BranchId> choice;
    if (i != open.back()) {
      choice = free_branch(fmt::format("{} is meant", ways[i].name), form);
      graph_.branches[*choice].if_true = test;
      here = *choice;
    }
    (before ? graph_.branches[*before].if_false : graph_.branches[some].if_true) = here;
    before = choice;
  }
  graph_.branches[some].guard = disjunction(guards);
  return some;
}

/// A perform of an object that the plan describes only.
std::optional<PlanTarget> Explorer::refer(PlanState& state, const StopPerform& stop,
                                          const PerformResolver::Reference& reference) {
  const auto& binding = *reference.binding;
  const auto index = static_cast<std::size_t>(&binding - binding_.objects.data());
  const auto source = data_.source(stop.form);
  if (index >= options_.candidates.size() || options_.candidates[index].empty()) {
    sink_.error(codes::kDesignatorValue, source, "performed", "object",
                "a description that no constant of the model can meet");
    return std::nullopt;
  }
  const auto failure = code_.classes.canonical(binding.failure_class);
  if (!failure) {
    sink_.error(codes::kUnknownFailureClass, binding.failure_source, binding.failure_class);
    return std::nullopt;
  }
  // Nothing but this ends a plan that tries again and again at one timepoint.
  if (++state.missed > options_.limits.max_loop) {
    return terminal(TerminalKind::kBound, "perform", stop.form);
  }
  auto key = state_key(state, values_, true);
  key.push_back(stop.designator.index());
  key.push_back(state.missed);
  const auto found = references_.find(key);
  if (found != references_.end()) return found->second;
  std::vector<ModelWay> ways;
  for (const auto& name : options_.candidates[index]) {
    auto guard = resolver_.candidate(reference, name, source);
    if (!guard) return std::nullopt;
    ways.push_back({*std::move(guard), name, {}});
  }
  const auto some = one_of(ways, stop.form, [&](std::uint32_t number) {
    if (number == 0) return Job{state, values_.failure(*failure), {}};
    return Job{state, {}, named(stop, reference, ways[number - 1].name)};
  });
  references_.emplace(std::move(key), some);
  return some;
}

}  // namespace parallax::compiler
