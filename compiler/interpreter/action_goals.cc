// Goals of actions: what is so already needs no action. The model decides where it is performed.
#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "compiler/base/codes/plans.h"
#include "compiler/interpreter/explorer.h"

namespace parallax::compiler {

base::Result<std::optional<FormulaTree>> PerformResolver::goal_formula(ValueId goal,
                                                                       base::SourceRange source) {
  const auto items = values_.elements(goal);
  const bool named = items && !items->empty() && values_.kind(items->front()) == ValueKind::kSymbol;
  const auto name = named ? values_[items->front()].text : values_.print(goal);
  for (const auto& bound : binding_.goals) {
    if (!named || bound.name != name || bound.variables.size() + 1 != items->size()) continue;
    auto formula = query_formula(bound, std::span(*items).subspan(1), source);
    if (!formula) return sink_.already_reported();
    return std::optional(*std::move(formula));
  }
  const std::pair told(source, name);
  if (std::find(unbound_goals_.begin(), unbound_goals_.end(), told) == unbound_goals_.end()) {
    unbound_goals_.push_back(told);
    sink_.warning(codes::kUnboundGoal, source, name);
  }
  return std::optional<FormulaTree>();
}

Explorer::Ruled Explorer::ask_goal(PlanState& state, const StopPerform& perform) {
  const auto goal = values_.key(perform.designator, "goal");
  const bool action = values_[perform.designator].designator == DesignatorKind::kAction;
  if (!goal || !action || values_.is_nil(*goal)) return {true, {}, {}};
  auto formula = resolver_.goal_formula(*goal, data_.source(perform.form));
  if (!formula) return {};
  if (!*formula) return {true, {}, {}};
  auto states = state_key(state, values_, true);
  states.push_back(perform.designator.index());
  states.push_back(perform.form.index());
  std::pair key(std::move(states), **std::move(formula));
  const auto found = branches_.find(key);
  if (found != branches_.end()) return {false, found->second, {}};
  if (!has_room(key.first, perform.form)) return {};
  const auto id = branch(key.second, perform.form);
  branches_.emplace(std::move(key), id);
  jobs_.push_back({state, {}, {}, Job::Edge::kFalse, id.index()});
  jobs_.back().begin = perform;
  jobs_.push_back({state, {}, {}, Job::Edge::kTrue, id.index()});
  jobs_.back().state.stack.push_back(values_.nil());
  return {false, id, {}};
}

}  // namespace parallax::compiler
