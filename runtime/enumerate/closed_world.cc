#include "runtime/enumerate/closed_world.h"

#include <map>
#include <utility>

#include "runtime/enumerate/demanded_events.h"

namespace parallax::runtime {

void require_reasons(SolverSession& session) {
  const auto& model = session.model();
  const auto demandable = demandable_events(model);
  if (demandable.empty() || model.plan.empty()) return;
  std::map<std::int32_t, std::vector<Literal>> reasons;  // by the variable of an event
  const compiler::AtomIndex index(model);
  for (const auto event : demandable) {
    for (Timepoint t = 0; t < model.horizon; ++t) {
      auto& known = reasons[model.variable(*model.events[event.index()].slot, t)];
      for (std::uint32_t step = 0; step < model.plan.size(); ++step) {
        if (model.plan[step].event != model.events[event.index()].name) continue;
        if (const auto at = index.at(compiler::PlanStepId(step), t)) known.push_back(*at);
      }
    }
  }
  for (std::size_t c = 0; c < model.clauses.size(); ++c) {
    if (model.origins[model.clause_origins[c]].kind != compiler::OriginKind::kAxiom) continue;
    for (const auto literal : model.clauses[c]) {
      const auto found = literal.is_positive() ? reasons.find(literal.var()) : reasons.end();
      if (found == reasons.end()) continue;
      // The reason is that every other literal of the clause is false.
      const auto reason = session.new_variable();
      for (const auto other : model.clauses[c]) {
        if (other != literal) session.add_clause(std::vector{~reason, ~other});
      }
      found->second.push_back(reason);
    }
  }
  for (auto& [variable, any] : reasons) {
    any.push_back(~Literal::positive(variable));
    session.add_clause(any);
  }
}

ClosedWorld::ClosedWorld(const CompiledModel& model, std::unique_ptr<SatSolver> solver)
    : model_(&model), session_(model, std::move(solver)), is_demandable_(model.events.size()) {
  for (const auto event : demandable_events(model)) is_demandable_[event.index()] = true;
}

base::Known ClosedWorld::admits(const Trace& trace, const std::vector<std::string>& performed) {
  std::vector<Literal> past;  // states and events up to the timepoint that is looked at
  const auto state = [&](std::size_t t) {
    for (std::uint32_t f = 0; f < model_->fluents.size(); ++f) {
      const auto literal = model_->holds_at(compiler::FluentId(f), static_cast<Timepoint>(t));
      if (!literal) continue;
      past.push_back(contains(trace.points[t].holds, compiler::FluentId(f)) ? *literal : ~*literal);
    }
  };
  for (std::size_t t = 0; t + 1 < trace.points.size() && t < performed.size(); ++t) {
    state(t);
    const auto& happens = trace.points[t].happens;
    auto fixed = past;
    std::vector<Literal> others;  // happen, and might be left out
    for (std::uint32_t e = 0; e < model_->events.size(); ++e) {
      const auto slot = model_->events[e].slot;
      if (!slot) continue;
      const auto literal = Literal::positive(model_->variable(*slot, static_cast<Timepoint>(t)));
      const bool here = contains(happens, compiler::EventId(e));
      past.push_back(here ? literal : ~literal);
      const bool may_go = here && is_demandable_[e] && model_->events[e].name != performed[t];
      if (may_go) {
        others.push_back(literal);
      } else {
        fixed.push_back(past.back());
      }
    }
    for (const auto other : others) {
      auto without = fixed;
      without.push_back(~other);
      const auto status = session_.solve(static_cast<Timepoint>(t + 1), without);
      if (status == SolveStatus::kUnknown) return base::Known::kUndecided;
      if (status == SolveStatus::kSatisfiable) return base::Known::kNo;
    }
  }
  return base::Known::kYes;
}

}  // namespace parallax::runtime
