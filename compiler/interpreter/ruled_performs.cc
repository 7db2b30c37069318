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

/// The answer decides which way the proof goes on: it is made again with one answer more.
Explorer::Ruled Explorer::ask_model(const Job& job, const ProofQuestion& question, DatumId form) {
  if (question.ways.empty()) return {false, terminal(TerminalKind::kNever, {}, std::nullopt), {}};
  auto key = state_key(job.state, values_, true);
  const bool performs = std::holds_alternative<StopPerform>(*job.proof);
  key.push_back(performs ? std::get<StopPerform>(*job.proof).designator.index()
                         : std::get<StopProof>(*job.proof).goal.index());
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
  machine_.refresh_links(job.state, std::span(&proof.goal, 1));
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
  job.state.stack.push_back(std::get<ProofValue>(result).value);
  return {true, {}, {}};
}

}  // namespace parallax::compiler
