// A model and its plan as the clauses of single steps that go on for ever.
//
// Control of the plan becomes slots of the state, and all clauses are split into windows of two
// neighbouring timepoints (layered_model.cc). If the windows before the horizon repeat with some
// period, which has to be seen twice, they go on behind it: phases are the windows before the
// repetition and one round of it. Axioms and plan are kept apart and joined for steps that both
// take, as a step may be one of the model alone while control stands still; definitions belong
// to both. Values are propagated from the clauses of timepoint 0 only, since a trace may end
// early.
//
// Linear in the clauses; the period takes at most the square of the horizon.

#include "runtime/monitor/step_windows.h"

#include <algorithm>
#include <utility>

#include "runtime/graph/unit_values.h"
#include "runtime/monitor/plan_slots.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {
namespace {

using compiler::AtomKind;
using compiler::CompiledModel;

/// Values that unit propagation finds without looking ahead, since a trace may end early.
std::vector<std::int8_t> values_at_start(const CompiledModel& model) {
  CompiledModel first = model;
  first.clauses = {};
  for (std::size_t c = 0; c < model.clauses.size(); ++c) {
    if (model.clause_timepoints[c] <= 0) first.clauses.add(model.clauses[c]);
  }
  return unit_values(first);
}

/// The least period with which the windows before the horizon repeat; one whole period occurs
/// twice.
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

/// Finds the phases: the windows before the repetition, and one round of those that repeat.
void find_phases(StepPart& out) {
  const auto period = period_of(out.window_of);
  if (!period) return;
  auto begin = out.window_of.size() - *period;
  while (begin > 0 && out.window_of[begin - 1] == out.window_of[begin - 1 + *period]) --begin;
  out.window_of.resize(begin + *period);
  out.comes_after = static_cast<std::uint32_t>(begin);
}

/// Clauses over variables without a timepoint, which belong to no window: can they hold at all?
bool can_begin(const CompiledModel& model) {
  const auto solver = make_cadical_solver();
  for (std::size_t c = 0; c < model.clauses.size(); ++c) {
    if (model.clause_timepoints[c] <= 0) solver->add_clause(model.clauses[c]);
  }
  return solver->solve() == SolveStatus::kSatisfiable;
}

/// Which clauses are about the plan, and which define what both axioms and plan may use.
class WindowParting {
 public:
  explicit WindowParting(const StepWindows& windows) : windows_(windows), model_(windows.model) {
    definitions_.resize(model_.fixed.size());
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      const auto clause = model_.clauses[c];
      if (!is_definition(c) || clause.empty() || !is_fixed(clause.front())) continue;
      definitions_[index(clause.front())].push_back(c);
    }
  }

  CompiledModel part(bool of_plan) const {
    CompiledModel out = model_;
    out.clauses = {};
    out.clause_timepoints.clear();
    out.clause_origins.clear();
    out.clause_is_definition.clear();
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      if (!is_common(c) && is_of_plan(c) != of_plan) continue;
      out.clauses.add(model_.clauses[c]);
      out.clause_timepoints.push_back(model_.clause_timepoints[c]);
      out.clause_origins.push_back(model_.clause_origins[c]);
      out.clause_is_definition.push_back(model_.clause_is_definition[c]);
    }
    return out;
  }

  /// A predicate that nothing settles and that both ask for. Each part has its own variables, so
  /// that it would not be the same one.
  std::string shared_predicate() const {
    const auto of_axioms = predicates(false), of_plan = predicates(true);
    for (const auto v : windows_.layered.open_fixed) {
      const auto i = static_cast<std::size_t>(v) - 1;
      if (of_axioms[i] && of_plan[i]) return model_.fixed[i].name;
    }
    return {};
  }

 private:
  bool is_fixed(Literal literal) const { return literal.var() <= model_.base(); }
  static std::size_t index(Literal literal) { return static_cast<std::size_t>(literal.var()) - 1; }
  bool is_definition(std::size_t c) const { return model_.clause_is_definition[c]; }
  std::uint32_t slot(Literal literal) const {
    return static_cast<std::uint32_t>((literal.var() - model_.base() - 1) % model_.stride());
  }
  bool is_plan_slot(Literal literal) const {
    if (is_fixed(literal)) return false;
    const auto s = slot(literal);
    return s >= windows_.first_plan_slot && s < windows_.last_plan_slot &&
           model_.slots[s].kind != AtomKind::kUnused;
  }
  bool is_of_plan(std::size_t c) const {
    const auto clause = model_.clauses[c];
    return model_.origins[model_.clause_origins[c]].kind == compiler::OriginKind::kPlanStep ||
           std::any_of(clause.begin(), clause.end(),
                       [&](Literal literal) { return is_plan_slot(literal); });
  }
  /// Is the clause a definition, true in itself, or the clause about a slot that is never true?
  bool is_common(std::size_t c) const {
    const auto clause = model_.clauses[c];
    if (std::any_of(clause.begin(), clause.end(),
                    [&](Literal literal) { return is_plan_slot(literal); })) {
      return false;
    }
    const bool is_anchor = clause.size() == 1 && !is_fixed(clause.front()) &&
                           slot(clause.front()) < model_.state_slots &&
                           model_.slots[slot(clause.front())].kind == AtomKind::kUnused;
    return is_definition(c) || is_anchor;
  }

  /// The fixed variables that the part's clauses ask for, by what defines them as well.
  std::vector<bool> predicates(bool of_plan) const {
    std::vector<bool> out(model_.fixed.size(), false);
    std::vector<std::size_t> todo;
    const auto note = [&](std::size_t c) {
      for (const auto literal : model_.clauses[c]) {
        if (!is_fixed(literal) || out[index(literal)]) continue;
        out[index(literal)] = true;
        if (model_.fixed[index(literal)].kind == AtomKind::kAuxiliary) {
          todo.push_back(index(literal));
        }
      }
    };
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      if (!is_definition(c) && is_of_plan(c) == of_plan) note(c);
    }
    while (!todo.empty()) {
      const auto next = todo.back();
      todo.pop_back();
      for (const auto c : definitions_[next]) note(c);
    }
    for (std::size_t v = 0; v < out.size(); ++v) {
      out[v] = out[v] && model_.fixed[v].kind == AtomKind::kPredicate;
    }
    return out;
  }

  const StepWindows& windows_;
  const CompiledModel& model_;
  std::vector<std::vector<std::size_t>> definitions_;  // by fixed auxiliary: clauses
};

/// Empty, or the reason why the parts make no steps.
std::string split_parts(StepWindows& out, const std::vector<std::int8_t>& values) {
  if (out.first_plan_slot == out.last_plan_slot) {
    out.axioms = {out.layered.steps, out.layered.step_at, std::nullopt};
    WindowClauses nothing;
    nothing.variables = static_cast<std::int32_t>(out.layered.state_slots + out.layered.stride);
    out.plan = {{std::move(nothing)}, {0}, 0};
    return {};
  }
  const WindowParting parting(out);
  if (const auto shared = parting.shared_predicate(); !shared.empty()) {
    return "`" + shared + "` is open, and both the axioms and the plan ask for it";
  }
  for (const bool of_plan : {false, true}) {
    auto split = split_into_windows(parting.part(of_plan), Distinct::kObservable, values);
    if (auto* reason = std::get_if<std::string>(&split)) return std::move(*reason);
    auto& layered = std::get<LayeredModel>(split);
    (of_plan ? out.plan : out.axioms) = {std::move(layered.steps), std::move(layered.step_at),
                                         std::nullopt};
  }
  return {};
}

void note_plan_slots(const CompiledModel& model, StepWindows& out) {
  out.locations.assign(model.plan.size(), out.model.state_slots);
  out.cuts.assign(model.plan_cuts.size(), out.model.state_slots);
  for (std::uint32_t slot = out.first_plan_slot; slot < out.last_plan_slot; ++slot) {
    const auto& [kind, name] = out.model.slots[slot];
    if (kind == AtomKind::kSucceeded) out.outcomes.push_back(slot);
    if (kind != AtomKind::kLocation) continue;
    const auto atom = compiler::plan_atom(kind, name);
    if (const auto* step = std::get_if<compiler::PlanStepId>(&atom)) {
      out.locations[step->index()] = slot;
    }
    if (const auto* cut = std::get_if<compiler::PlanCutId>(&atom)) {
      out.cuts[cut->index()] = slot;
    }
  }
}

}  // namespace

WindowClauses StepWindows::joined(std::uint32_t axiom_phase, std::uint32_t plan_phase) const {
  auto out = axioms.windows[axioms.window_of[axiom_phase]];
  const auto& other = plan.windows[plan.window_of[plan_phase]];
  const auto frame = static_cast<std::int32_t>(layered.state_slots + layered.stride);
  // Variables of one window alone are behind the frame, and others in each part.
  const auto moved = out.variables - frame;
  for (auto clause : other.clauses) {
    for (auto& literal : clause) {
      if (literal > frame) literal += moved;
      if (literal < -frame) literal -= moved;
    }
    out.clauses.push_back(std::move(clause));
  }
  out.variables += other.variables - frame;
  std::sort(out.clauses.begin(), out.clauses.end());
  out.clauses.erase(std::unique(out.clauses.begin(), out.clauses.end()), out.clauses.end());
  return out;
}

std::variant<std::unique_ptr<StepWindows>, std::string> step_windows(const CompiledModel& model,
                                                                     Beyond beyond) {
  auto out = std::make_unique<StepWindows>();
  out->model = with_plan_slots(model);
  const auto values = values_at_start(out->model);
  auto split = split_into_windows(out->model, Distinct::kObservable, values);
  if (auto* reason = std::get_if<std::string>(&split)) return std::move(*reason);
  out->layered = std::get<LayeredModel>(std::move(split));
  if (out->layered.has_unplaced && !can_begin(out->model)) {
    return std::string("its axioms contradict each other");
  }
  const bool has_plan = !model.plan.empty() || !model.plan_cuts.empty();
  out->first_plan_slot = has_plan ? model.state_slots : out->model.state_slots;
  out->last_plan_slot = out->model.state_slots;
  note_plan_slots(model, *out);
  if (auto reason = split_parts(*out, values); !reason.empty()) return reason;
  out->ends = beyond == Beyond::kNothing;
  if (!out->ends) {
    find_phases(out->axioms);
    if (has_plan) find_phases(out->plan);
  }
  return out;
}

}  // namespace parallax::runtime
