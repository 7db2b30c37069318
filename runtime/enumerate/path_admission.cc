#include "runtime/enumerate/path_admission.h"

#include <algorithm>
#include <utility>

#include "compiler/base/contract.h"

namespace parallax::runtime {

using base::Known;
using compiler::AtomKind;

namespace {

/// The events that no axiom can demand, by slot: in the clauses of axioms they stand under a
/// negation only. That something else would explain a change of state (frame axioms) is no demand.
std::vector<std::uint32_t> undemanded_events(const CompiledModel& model) {
  std::vector<bool> demanded(model.slots.size(), false);
  for (std::size_t c = 0; c < model.clauses.size(); ++c) {
    if (model.origins[model.clause_origins[c]].kind != compiler::OriginKind::kAxiom) continue;
    for (const auto literal : model.clauses[c]) {
      if (!literal.is_positive() || literal.var() <= model.base()) continue;
      const auto place = literal.var() - model.base() - 1;
      demanded[static_cast<std::size_t>(place % model.stride())] = true;
    }
  }
  std::vector<std::uint32_t> out;
  for (const auto& event : model.events) {
    if (event.slot && !demanded[*event.slot]) out.push_back(*event.slot);
  }
  return out;
}

}  // namespace

PathAdmission::PathAdmission(SolverSession& session)
    : session_(&session), index_(session.model()), undemanded_(undemanded_events(session.model())) {
  const auto& events = session.model().events;
  for (std::uint32_t i = 0; i < events.size(); ++i) events_.emplace(events[i].name, i);
}

Known PathAdmission::admits(std::span<const ExecutedPerform> performs, std::size_t outcomes,
                            std::span<const State> observed) {
  const auto& model = session_->model();
  const auto n = static_cast<Timepoint>(performs.size());
  PARALLAX_REQUIRE(n <= model.horizon && observed.size() <= performs.size() + 1,
                   "a path within the horizon");
  std::vector<Literal> assumptions;
  // What has no atom is false in every execution.
  const auto assume = [&](const std::optional<Literal>& literal, bool wanted) {
    if (literal) assumptions.push_back(wanted ? *literal : ~*literal);
    return literal.has_value() || !wanted;
  };
  for (Timepoint t = 0; t < n; ++t) {
    const auto& perform = performs[static_cast<std::size_t>(t)];
    const auto event = events_.find(perform.event);
    if (event == events_.end() || !model.events[event->second].slot) return Known::kNo;
    const auto performed = *model.events[event->second].slot;
    assumptions.push_back(Literal::positive(model.variable(performed, t)));
    // Else anything that might happen by itself would excuse any difference.
    for (const auto slot : undemanded_) {
      if (slot != performed) assumptions.push_back(~Literal::positive(model.variable(slot, t)));
    }
    if (!assume(index_.at(perform.step, t), true)) return Known::kNo;
    if (static_cast<std::size_t>(t) >= outcomes) continue;
    if (!assume(index_.succeeded(perform.step, t + 1), perform.succeeded)) return Known::kNo;
    if (!perform.succeeded || perform.returned.empty()) continue;
    const compiler::PlanAtom object = compiler::ReturnedObject{perform.returned};
    if (!assume(index_.plan(AtomKind::kResult, object, t + 1), true)) return Known::kNo;
  }
  for (std::size_t t = 0; t < observed.size(); ++t) {
    for (const auto& [fluent, holds] : observed[t]) {
      if (!assume(model.holds_at(fluent, static_cast<Timepoint>(t)), holds)) return Known::kNo;
    }
  }
  return possible(session_->solve(n, assumptions));
}

InitialStates initial_states(const CompiledModel& model, std::unique_ptr<SatSolver> solver,
                             std::span<const compiler::FluentId> fluents, std::size_t limit) {
  SolverSession session(model, std::move(solver));
  InitialStates out;
  for (;;) {
    const auto status = session.solve(0, {});
    if (status != SolveStatus::kSatisfiable) {
      out.stopped = status == SolveStatus::kUnknown;
      break;
    }
    if (out.states.size() == limit) {
      out.more = true;
      break;
    }
    auto& state = out.states.emplace_back();
    std::vector<Literal> other;
    for (const auto fluent : fluents) {
      const auto literal = model.holds_at(fluent, 0);
      if (!literal) continue;
      const bool holds = session.value(*literal);
      if (holds) state.push_back(fluent);
      other.push_back(holds ? ~*literal : *literal);
    }
    std::sort(state.begin(), state.end());
    if (other.empty()) break;
    session.add_clause(other);
  }
  std::sort(out.states.begin(), out.states.end());
  return out;
}

Known predicate_value(SolverSession& session, std::string_view name) {
  const compiler::AtomIndex index(session.model());
  const auto literal = index.find(AtomKind::kPredicate, name, std::nullopt);
  if (!literal) return Known::kNo;
  const auto with = session.solve(0, std::span(&*literal, 1));
  const auto opposite = ~*literal;
  const auto without = session.solve(0, std::span(&opposite, 1));
  if (with == SolveStatus::kUnsatisfiable) return Known::kNo;
  if (with == SolveStatus::kSatisfiable && without == SolveStatus::kUnsatisfiable) {
    return Known::kYes;
  }
  return Known::kUndecided;
}

}  // namespace parallax::runtime
