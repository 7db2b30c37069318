// Performs without an entry in the binding table, and goals of `prolog`: the rules of the plan
// define their meaning, and the model answers what the rules ask.
#include <utility>

#include "compiler/base/codes/plans.h"
#include "compiler/interpreter/explorer.h"

namespace parallax::compiler {
namespace {

/// Keeps what functions called by rules have made and changed, also where the proof fails.
void take_changes(DesignatorLinks& links, const DesignatorLinks& proved) {
  links.chains = proved.chains;
  links.heap = proved.heap;
  links.next = proved.next;
}

}  // namespace

/// Is the action missing in the table, so that the rules define its meaning?
bool Explorer::is_ruled(const StopPerform& perform) const {
  const auto& value = values_[perform.designator];
  const bool action =
      value.kind == ValueKind::kDesignator && value.designator == DesignatorKind::kAction;
  return action && rules_.has_grounding_rules() && !resolver_.has_entry(perform.designator);
}

Explorer::Ruled Explorer::ask_rules(Job& job) {
  const auto proof = *std::exchange(job.proof, std::nullopt);
  if (const auto* perform = std::get_if<StopPerform>(&proof)) return ground(job, *perform);
  return prove(job, std::get<StopProof>(proof));
}

/// A branch of a `par` asks when it has its turn: what others perform first may change the answer.
Explorer::Ruled Explorer::wait_to_ask(Job& job, const PlanTurn& turn) {
  job.proof.reset();
  return {true, {}, machine_.wait(job.state, turn)};
}

/// The turn at which a branch asks what the proof is about.
PlanTurn turn_of(const std::variant<StopPerform, StopProof>& proof) {
  PlanTurn turn;
  if (const auto* perform = std::get_if<StopPerform>(&proof)) {
    turn = {perform->designator, perform->form};
    turn.asks = TurnQuestion::kGrounding;
    return turn;
  }
  const auto& goal = std::get<StopProof>(proof);
  turn = {goal.action ? goal.action->designator : goal.goal, goal.form};
  turn.asks = goal.all ? TurnQuestion::kAllProofs : TurnQuestion::kProof;
  if (goal.action) turn.asks = TurnQuestion::kGoal;
  return turn;
}

/// The answer decides which way the proof goes on: it is made again with one answer more.
Explorer::Ruled Explorer::ask_model(Job& job, const ProofQuestion& question, DatumId form) {
  if (question.ways.empty()) return {false, terminal(TerminalKind::kNever, {}, std::nullopt), {}};
  if (job.answers.empty() && must_wait(job)) return wait_to_ask(job, turn_of(*job.proof));
  auto key = state_key(job.state, values_, true);
  const auto* performs = std::get_if<StopPerform>(&*job.proof);
  const auto* goal = std::get_if<StopProof>(&*job.proof);
  key.push_back(performs != nullptr ? performs->designator.index() : goal->goal.index());
  if (goal != nullptr && goal->action) key.push_back(goal->action->designator.index());
  key.push_back(form.index());
  key.insert(key.end(), job.answers.begin(), job.answers.end());
  const auto found = references_.find(key);
  if (found != references_.end()) return {false, found->second, {}};
  if (!has_room(key, form)) return {};
  const auto target = one_of(question.ways, form, [&](std::uint32_t number) {
    Job next{job.state, {}, {}};
    next.proof = job.proof;
    next.answers = job.answers;
    next.answers.push_back(number);
    return next;
  });
  references_.emplace(std::move(key), target);
  return {false, target, {}};
}

/// No rule carries the action out: it fails as in CRAM if there is a rule of its type, else the
/// action is unknown.
Explorer::Ruled Explorer::nothing_fits(Job& job, const StopPerform& perform, bool fits) {
  if (!fits) {
    resolver_.find_entry(perform.designator, data_.source(perform.form));
    return {};
  }
  // Nothing but this ends a plan that tries again and again at one timepoint.
  if (++job.state.missed > options_.limits.max_loop) {
    return {false, terminal(TerminalKind::kBound, "perform", perform.form), {}};
  }
  return {true, {}, machine_.raise(job.state, values_.failure("designator-reference-failure"))};
}

Explorer::Ruled Explorer::ground(Job& job, const StopPerform& perform) {
  machine_.refresh_links(job.state, std::span(&perform.designator, 1));
  auto result = rules_.ground(perform, job.state.links, job.answers);
  if (const auto* question = std::get_if<ProofQuestion>(&result)) {
    job.proof = perform;
    return ask_model(job, *question, perform.form);
  }
  job.answers.clear();
  if (std::holds_alternative<ProofError>(result)) return {};
  take_changes(job.state.links, rules_.links());
  if (const auto* failed = std::get_if<ProofFailed>(&result)) {
    return {true, {}, machine_.raise(job.state, failed->failure)};
  }
  if (const auto* none = std::get_if<NoPlanCall>(&result)) {
    return nothing_fits(job, perform, none->fits);
  }
  const auto& call = std::get<PlanCall>(result);
  return {true, {}, machine_.enter(job.state, call.unit, call.arguments, perform.form)};
}

Explorer::Ruled Explorer::prove(Job& job, const StopProof& proof) {
  if (values_.kind(proof.goal) != ValueKind::kCons) {
    sink_.error(codes::kPlanValue, data_.source(proof.form), "prolog",
                "expected a quoted fluent such as '(holding left box)");
    return {};
  }
  const ValueId used[] = {proof.goal, proof.action ? proof.action->designator : proof.goal};
  machine_.refresh_links(job.state, used);
  auto result = rules_.prove(proof, job.state.links, job.answers);
  if (const auto* question = std::get_if<ProofQuestion>(&result)) {
    job.proof = proof;
    return ask_model(job, *question, proof.form);
  }
  job.answers.clear();
  if (std::holds_alternative<ProofError>(result)) return {};
  take_changes(job.state.links, rules_.links());
  if (const auto* failed = std::get_if<ProofFailed>(&result)) {
    return {true, {}, machine_.raise(job.state, failed->failure)};
  }
  const auto value = std::get<ProofValue>(result).value;
  if (!proof.action) {
    job.state.stack.push_back(value);
  } else if (values_.is_nil(value)) {
    job.begin = proof.action;
  } else {
    job.state.stack.push_back(values_.nil());  // it holds: nothing is done
  }
  return {true, {}, {}};
}

}  // namespace parallax::compiler
