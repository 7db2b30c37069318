#include "runtime/monitor/step_windows.h"

#include "runtime/graph/unit_values.h"
#include "runtime/monitor/plan_slots.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {
namespace {

using compiler::AtomKind;
using compiler::CompiledModel;

/// What unit propagation finds without looking ahead: a trace that ends early is one all the same.
std::vector<std::int8_t> values_at_start(const CompiledModel& model) {
  CompiledModel first = model;
  first.clauses = {};
  for (std::size_t c = 0; c < model.clauses.size(); ++c) {
    if (model.clause_timepoints[c] <= 0) first.clauses.add(model.clauses[c]);
  }
  return unit_values(first);
}

/// The least period with which the windows before the horizon repeat themselves: one whole round is
/// there twice.
std::optional<std::size_t> period_of(const std::vector<std::uint32_t>& steps) {
  for (std::size_t period = 1; 2 * period <= steps.size(); ++period) {
    bool repeats = true;
    for (std::size_t i = 1; i <= period && repeats; ++i) {
      repeats = steps[steps.size() - i] == steps[steps.size() - i - period];
    }
    if (repeats) return period;
  }
  return std::nullopt;
}

/// The phases: what comes before the windows repeat themselves, and one round of those.
void find_phases(StepWindows& out) {
  const auto period = period_of(out.window_of);
  if (!period) return;
  auto begin = out.window_of.size() - *period;
  while (begin > 0 && out.window_of[begin - 1] == out.window_of[begin - 1 + *period]) --begin;
  out.window_of.resize(begin + *period);
  out.comes_after = static_cast<std::uint32_t>(begin);
}

/// Clauses over variables without a timepoint, which no window has: can they hold at all?
bool can_begin(const CompiledModel& model) {
  const auto solver = make_cadical_solver();
  for (std::size_t c = 0; c < model.clauses.size(); ++c) {
    if (model.clause_timepoints[c] <= 0) solver->add_clause(model.clauses[c]);
  }
  return solver->solve() == SolveStatus::kSatisfiable;
}

}  // namespace

std::variant<std::unique_ptr<StepWindows>, std::string> step_windows(const CompiledModel& model,
                                                                     Beyond beyond) {
  auto out = std::make_unique<StepWindows>();
  out->model = with_plan_slots(model);
  auto split = split_into_windows(out->model, Distinct::kObservable, values_at_start(out->model));
  if (auto* reason = std::get_if<std::string>(&split)) return std::move(*reason);
  out->layered = std::get<LayeredModel>(std::move(split));
  if (out->layered.has_unplaced && !can_begin(out->model)) {
    return std::string("its axioms contradict each other");
  }
  out->window_of = out->layered.step_at;
  out->ends = beyond == Beyond::kNothing;
  if (!out->ends) find_phases(*out);
  out->locations.assign(model.plan.size(), out->model.state_slots);
  for (std::uint32_t slot = model.state_slots; slot < out->model.state_slots; ++slot) {
    const auto& [kind, name] = out->model.slots[slot];
    if (kind == AtomKind::kSucceeded) out->outcomes.push_back(slot);
    if (kind != AtomKind::kLocation) continue;
    const auto atom = compiler::plan_atom(kind, name);
    if (const auto* step = std::get_if<compiler::PlanStepId>(&atom)) {
      out->locations[step->index()] = slot;
    }
  }
  return out;
}

}  // namespace parallax::runtime
