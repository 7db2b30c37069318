#include "tools/repair/plan_model.h"

#include <algorithm>
#include <span>

#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/ground_name.h"
#include "compiler/repair/edit_grammar.h"

namespace parallax::tools {

using compiler::AtomKind;
using compiler::LocationId;
using compiler::Timepoint;
using runtime::Literal;
using runtime::SolveStatus;

std::unique_ptr<PlanModel> PlanModel::compile(const harness::Scenario& scenario,
                                              const EditedTexts& texts, Context& context,
                                              Wrong& wrong) {
  // Errors of edited texts are not reported; the scenario's texts are those of the context.
  const auto before = context.sink();
  context.sink() = base::DiagnosticSink();
  auto compiled = compile_edited(scenario, texts, context);
  wrong = {};
  for (const auto& diagnostic : context.sink().sorted()) {
    if (base::info(diagnostic.code).severity != base::Severity::kError) continue;
    if (wrong.why.empty()) wrong.why = diagnostic.message;
    if (diagnostic.range) wrong.places.push_back(*diagnostic.range);
    for (const auto& note : diagnostic.notes) {
      if (note.range) wrong.places.push_back(*note.range);
    }
  }
  context.sink() = before;
  if (!compiled || !compiled->plan) return nullptr;
  return std::unique_ptr<PlanModel>(new PlanModel(*std::move(compiled), context.stop()));
}

PlanModel::PlanModel(compiler::Compilation compilation, const std::atomic<bool>& stop)
    : compilation_(std::move(compilation)),
      compared_(compilation_.model),
      session_(compilation_.model, runtime::make_cadical_solver(&stop)),
      index_(compilation_.model) {}

std::optional<PlanModel::Literals> PlanModel::like(const Evidence& evidence, std::size_t steps,
                                                   std::size_t states) const {
  Literals out;
  for (std::size_t t = 0; t < steps; ++t) {
    const auto happens =
        index_.find(AtomKind::kHappens, evidence.steps[t].event, static_cast<Timepoint>(t));
    if (!happens) return std::nullopt;
    out.push_back(*happens);
  }
  if (!add_states(index_, evidence, states, out)) return std::nullopt;
  return out;
}

std::optional<PlanModel::Literals> PlanModel::start(const Evidence& evidence) const {
  return like(evidence, 0, 1);
}

std::vector<LocationId> PlanModel::locations(const Evidence& evidence, std::size_t t) {
  std::vector<LocationId> out;
  const auto facts = like(evidence, t, t + 1);
  if (!facts || static_cast<Timepoint>(t) > horizon()) return out;
  const auto& graph = this->graph();
  auto wanted = *facts;
  // Requires that the plan has come to a perform of this event.
  std::vector<Literal> here;
  const auto symbol = base::symbol_of(evidence.steps[t].event);
  const auto guard = session_.new_variable();
  here.push_back(~guard);
  for (std::uint32_t i = 0; i < graph.locations.size(); ++i) {
    if (graph.locations[LocationId(i)].event_symbol != symbol) continue;
    const auto at = index_.at(compiler::PlanStepId(i), static_cast<Timepoint>(t));
    if (at) here.push_back(*at);
  }
  session_.add_clause(here);
  wanted.push_back(guard);
  if (session_.solve(static_cast<Timepoint>(t), wanted) != SolveStatus::kSatisfiable) return out;
  for (std::size_t k = 0; k <= t; ++k) {
    for (std::uint32_t i = 0; i < graph.locations.size(); ++i) {
      const auto at = index_.at(compiler::PlanStepId(i), static_cast<Timepoint>(k));
      if (at && session_.value(*at)) out.push_back(LocationId(i));
    }
  }
  return out;
}

void PlanModel::set_bad(const BadStep& bad) {
  clean_ = session_.new_variable();
  bad_.assign(static_cast<std::size_t>(horizon()), {});
  const auto symbol = base::symbol_of(bad.step.event);
  for (Timepoint t = 0; t < horizon(); ++t) {
    const auto happens = index_.find(AtomKind::kHappens, bad.step.event, t);
    if (!happens) continue;
    const auto add = [&](Literals all) {
      const auto meant = session_.new_variable();
      Literals forbidden = {~*clean_};
      for (const auto literal : all) {
        session_.add_clause(std::vector<Literal>{~meant, literal});
        forbidden.push_back(~literal);
      }
      session_.add_clause(forbidden);
      bad_[static_cast<std::size_t>(t)].push_back(meant);
    };
    if (!bad.step.failed || !bad.where.empty()) {
      Literals all = {*happens};
      bool possible = true;
      const auto at = bad.where.empty() ? t + 1 : t;
      for (const auto& [fluent, holds] : bad.where.empty() ? bad.seen : bad.where) {
        const auto literal = index_.find(AtomKind::kHoldsAt, fluent, at);
        possible = possible && (literal || !holds);
        if (literal) all.push_back(holds ? *literal : ~*literal);
      }
      if (possible) add(std::move(all));
      continue;
    }
    // The world refuses the event again: the perform does not succeed.
    for (std::uint32_t i = 0; i < graph().locations.size(); ++i) {
      if (graph().locations[LocationId(i)].event_symbol != symbol) continue;
      const compiler::PlanStepId step(i);
      const auto at = index_.at(step, t), succeeded = index_.succeeded(step, t + 1);
      if (!at) continue;
      Literals all = {*happens, *at};
      if (succeeded) all.push_back(~*succeeded);
      add(std::move(all));
    }
  }
}

std::optional<bool> PlanModel::can_be_bad() {
  for (Timepoint t = 0; t < horizon(); ++t) {
    for (const auto literal : bad_[static_cast<std::size_t>(t)]) {
      const auto status = session_.solve(t + 1, std::span(&literal, 1));
      if (status == SolveStatus::kUnknown) return std::nullopt;
      if (status == SolveStatus::kSatisfiable) return true;
    }
  }
  return false;
}

SolveStatus PlanModel::solve(const PlanGoal& goal, Timepoint n, Literals facts, std::size_t after) {
  const auto hit = index_.hit(n);
  const auto done = index_.plan(AtomKind::kLocation, compiler::PlanEnd{"DONE"}, n);
  if ((goal.constraints && !goal.done && !hit) || (goal.done && !done)) {
    return SolveStatus::kUnsatisfiable;
  }
  if (goal.constraints && goal.done) {
    const auto key = std::pair(n, after);
    if (!hits_.contains(key)) {
      const auto guard = session_.new_variable();
      Literals any = {~guard};
      for (auto t = static_cast<Timepoint>(after + 1); t <= n; ++t) {
        if (const auto literal = index_.hit(t)) any.push_back(*literal);
      }
      session_.add_clause(any);
      hits_.emplace(key, guard);
    }
    facts.push_back(hits_.at(key));
  } else if (goal.constraints) {
    facts.push_back(*hit);
  }
  if (goal.done) facts.push_back(*done);
  if (!goal.event.empty()) {
    if (!happened_.contains(n)) {
      const auto guard = session_.new_variable();
      Literals any = {~guard};
      for (Timepoint t = 0; t < n; ++t) {
        if (const auto literal = index_.find(AtomKind::kHappens, goal.event, t)) {
          any.push_back(*literal);
        }
      }
      session_.add_clause(any);
      happened_.emplace(n, guard);
    }
    facts.push_back(happened_.at(n));
  }
  return session_.solve(n, facts);
}

std::optional<bool> PlanModel::reaches(const PlanGoal& goal, const Literals& facts,
                                       std::size_t after) {
  for (auto n = static_cast<Timepoint>(after + 1); n <= horizon(); ++n) {
    const auto status = solve(goal, n, facts, after);
    if (status == SolveStatus::kUnknown) return std::nullopt;
    if (status == SolveStatus::kSatisfiable) {
      length_ = n;
      return true;
    }
  }
  return false;
}

}  // namespace parallax::tools
