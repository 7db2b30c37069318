#include "runtime/enumerate/path_admission.h"

#include <algorithm>
#include <utility>

#include "compiler/base/contract.h"
#include "runtime/enumerate/demanded_events.h"

namespace parallax::runtime {

using base::Known;
using compiler::AtomKind;

std::vector<std::uint32_t> undemanded_events(const CompiledModel& model) {
  const auto demandable = demandable_events(model);
  std::vector<std::uint32_t> out;
  for (std::uint32_t e = 0; e < model.events.size(); ++e) {
    const auto slot = model.events[e].slot;
    if (slot && !std::binary_search(demandable.begin(), demandable.end(), compiler::EventId(e))) {
      out.push_back(*slot);
    }
  }
  return out;
}

PathAdmission::PathAdmission(SolverSession& session) : PathAdmission(session.model()) {
  session_ = &session;
}

PathAdmission::PathAdmission(const CompiledModel& model)
    : model_(&model), index_(model), undemanded_(undemanded_events(model)) {
  for (std::uint32_t i = 0; i < model.events.size(); ++i) {
    events_.emplace(model.events[i].name, i);
  }
}

std::optional<std::vector<Literal>> PathAdmission::facts(std::span<const ExecutedPerform> performs,
                                                         std::size_t outcomes,
                                                         std::span<const State> observed) const {
  const auto& model = *model_;
  std::vector<Literal> out;
  // A fluent without an atom is false in every execution.
  const auto state = [&](const std::optional<Literal>& literal, bool wanted) {
    if (literal) out.push_back(wanted ? *literal : ~*literal);
    return literal.has_value() || !wanted;
  };
  for (std::size_t i = 0; i < performs.size(); ++i) {
    const auto t = static_cast<Timepoint>(i);
    const auto& perform = performs[i];
    const auto event = events_.find(perform.event);
    if (event == events_.end() || !model.events[event->second].slot) return std::nullopt;
    const auto performed = *model.events[event->second].slot;
    out.push_back(Literal::positive(model.variable(performed, t)));
    // Else anything that might happen by itself would excuse any difference.
    for (const auto slot : undemanded_) {
      if (slot != performed) out.push_back(~Literal::positive(model.variable(slot, t)));
    }
    if (!perform.step) continue;
    if (!state(index_.at(*perform.step, t), true)) return std::nullopt;
    if (i >= outcomes) continue;
    if (!state(index_.succeeded(*perform.step, t + 1), perform.succeeded)) return std::nullopt;
    if (!perform.succeeded || perform.returned.empty()) continue;
    const compiler::PlanAtom object = compiler::ReturnedObject{perform.returned};
    if (!state(index_.plan(AtomKind::kResult, object, t + 1), true)) return std::nullopt;
  }
  for (std::size_t t = 0; t < observed.size(); ++t) {
    for (const auto& [fluent, holds] : observed[t]) {
      if (!state(model.holds_at(fluent, static_cast<Timepoint>(t)), holds)) return std::nullopt;
    }
  }
  return out;
}

Known PathAdmission::admits(std::span<const ExecutedPerform> performs, std::size_t outcomes,
                            std::span<const State> observed) {
  PARALLAX_REQUIRE(session_ != nullptr, "a session that can be asked");
  const auto n = static_cast<Timepoint>(performs.size());
  PARALLAX_REQUIRE(n <= model_->horizon && observed.size() <= performs.size() + 1,
                   "a path within the horizon");
  const auto assumptions = facts(performs, outcomes, observed);
  return assumptions ? possible(session_->solve(n, *assumptions)) : Known::kNo;
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
