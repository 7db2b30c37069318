// Goals of actions: what is so already needs no action. The binding table says what a goal means in
// the model, or a query or the rules of the plan prove it, as CRAM's `holds` does.
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
  return std::optional<FormulaTree>();
}

void PerformResolver::tell_unbound_goal(ValueId goal, base::SourceRange source) {
  const auto items = values_.elements(goal);
  const bool named = items && !items->empty() && values_.kind(items->front()) == ValueKind::kSymbol;
  const auto name = named ? values_[items->front()].text : values_.print(goal);
  const std::pair told(source, name);
  if (std::find(unbound_goals_.begin(), unbound_goals_.end(), told) == unbound_goals_.end()) {
    unbound_goals_.push_back(told);
    sink_.warning(codes::kUnboundGoal, source, name);
  }
}

std::optional<Explorer::Ruled> Explorer::ask_goal(Job& job, const StopPerform& perform) {
  const auto goal = values_.key(perform.designator, "goal");
  const bool action = values_[perform.designator].designator == DesignatorKind::kAction;
  if (!goal || !action || values_.is_nil(*goal)) return std::nullopt;
  const auto source = data_.source(perform.form);
  auto formula = resolver_.goal_formula(*goal, source);
  if (!formula) return Ruled();
  if (!*formula && !rules_.knows(*goal)) {
    resolver_.tell_unbound_goal(*goal, source);
    return std::nullopt;
  }
  if (!*formula) {
    job.proof = StopProof{*goal, perform.form, false, perform};
    return Ruled{true, {}, {}};
  }
  if (must_wait(job)) {
    PlanTurn turn{perform.designator, perform.form};
    turn.asks = TurnQuestion::kGoal;
    return wait_to_ask(job, turn);
  }
  const auto& state = job.state;
  auto states = state_key(state, values_, true);
  states.push_back(perform.designator.index());
  states.push_back(perform.form.index());
  std::pair key(std::move(states), **std::move(formula));
  const auto found = branches_.find(key);
  if (found != branches_.end()) return Ruled{false, found->second, {}};
  if (!has_room(key.first, perform.form)) return Ruled();
  const auto id = branch(key.second, perform.form);
  branches_.emplace(std::move(key), id);
  jobs_.push_back({state, {}, {}, Job::Edge::kFalse, id.index()});
  jobs_.back().begin = perform;
  jobs_.push_back({state, {}, {}, Job::Edge::kTrue, id.index()});
  jobs_.back().state.stack.push_back(values_.nil());
  return Ruled{false, id, {}};
}

}  // namespace parallax::compiler
