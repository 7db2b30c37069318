// Performs of objects that the plan describes only: any one of those that meet the description.
#include <fmt/core.h>

#include <cstddef>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/explorer.h"

namespace parallax::compiler {

using base::DiagnosticCode;

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

/// Any one of the candidates whose formula holds: free branches choose, and a choice that does not
/// hold is no execution.
bool Explorer::choose(const PlanState& state, const StopPerform& stop,
                      const PerformResolver::Reference& reference, BranchId some) {
  const auto& names =
      options_.candidates[static_cast<std::size_t>(reference.binding - binding_.objects.data())];
  const auto never = terminal(TerminalKind::kNever, {}, std::nullopt);
  std::vector<FormulaTree> guards;
  std::optional<BranchId> before;
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto guard = resolver_.candidate(reference, names[i], data_.source(stop.form));
    if (!guard) return false;
    guards.push_back(*guard);
    const auto test = branch(*std::move(guard), stop.form);
    graph_.branches[test].if_false = never;
    jobs_.push_back({state, {}, named(stop, reference, names[i]), Job::Edge::kTrue, test.index()});
    PlanTarget here = test;
    std::optional<BranchId> choice;
    if (i + 1 < names.size()) {
      choice = free_branch(fmt::format("{} is meant", names[i]), stop.form);
      graph_.branches[*choice].if_true = test;
      here = *choice;
    }
    (before ? graph_.branches[*before].if_false : graph_.branches[some].if_true) = here;
    before = choice;
  }
  graph_.branches[some].guard = disjunction(guards);
  return true;
}

/// A perform of an object that the plan describes only.
std::optional<PlanTarget> Explorer::refer(PlanState& state, const StopPerform& stop,
                                          const PerformResolver::Reference& reference) {
  const auto& binding = *reference.binding;
  const auto index = static_cast<std::size_t>(&binding - binding_.objects.data());
  const auto source = data_.source(stop.form);
  if (index >= options_.candidates.size() || options_.candidates[index].empty()) {
    sink_.error(DiagnosticCode::kDesignatorValue, source, "performed", "object",
                "a description that no constant of the model can meet");
    return std::nullopt;
  }
  const auto failure = code_.classes.canonical(binding.failure_class);
  if (!failure) {
    sink_.error(DiagnosticCode::kUnknownFailureClass, binding.failure_source,
                binding.failure_class);
    return std::nullopt;
  }
  // Nothing but this ends a plan that tries again and again at one timepoint.
  if (++state.missed > static_cast<std::uint32_t>(options_.max_loop)) {
    return terminal(TerminalKind::kBound, "perform", stop.form);
  }
  auto key = state_key(state, values_, true);
  key.push_back(stop.designator.index());
  key.push_back(state.missed);
  const auto found = references_.find(key);
  if (found != references_.end()) return found->second;
  const auto some = branch({}, stop.form);
  references_.emplace(std::move(key), some);
  jobs_.push_back({state, values_.failure(*failure), {}, Job::Edge::kFalse, some.index()});
  if (!choose(state, stop, reference, some)) return std::nullopt;
  return some;
}

}  // namespace parallax::compiler
