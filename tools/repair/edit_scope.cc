#include "tools/repair/edit_scope.h"

#include <algorithm>

#include "compiler/base/ground_name.h"

namespace parallax::tools {

using compiler::EditScope;

namespace {

constexpr std::size_t kLatestChange = 3;  // steps

/// Events with effects that neither a run nor an axiom brings about.
std::set<std::string> idle_events(const RepairInput& input, const std::set<std::string>& demanded) {
  std::set<std::string> out;
  for (const auto& form : input.domain->forms) {
    const bool effects = form.kind == compiler::AxiomForm::Kind::kEffects;
    if (effects && !demanded.contains(form.event_symbol)) out.insert(form.event_symbol);
  }
  for (const auto& seen : input.evidence) {
    for (const auto& step : seen.steps) out.erase(base::symbol_of(step.event));
  }
  return out;
}

/// Also counts changes after the parting: they tell what an event does, if not what the model says
/// of it.
void add_changed(const Evidence& seen, EditScope& scope) {
  for (std::size_t t = 0; t + 1 < seen.states.size(); ++t) {
    for (const auto& [fluent, holds] : seen.states[t + 1]) {
      const auto before = seen.states[t].find(fluent);
      if (before == seen.states[t].end() || before->second == holds) continue;
      scope.changed[base::symbol_of(seen.steps[t].event)].emplace(base::symbol_of(fluent), holds);
    }
  }
}

/// Steps of the events at which runs and model part, in runs that go on as the model says.
void add_successes(const Evidence& seen, EditScope& scope) {
  for (std::size_t t = 0; t < seen.steps.size() && seen.divergence.value_or(t + 2) > t + 1; ++t) {
    const auto symbol = base::symbol_of(seen.steps[t].event);
    const bool is_asked = std::any_of(scope.steps.begin(), scope.steps.end(), [&](const auto& at) {
      return base::symbol_of(at.event) == symbol;
    });
    if (!is_asked || seen.steps[t].failed) continue;
    EditScope::Success success{seen.steps[t].event, seen.states[t]};
    const auto& known = scope.successes;
    if (std::find(known.begin(), known.end(), success) == known.end()) {
      scope.successes.push_back(std::move(success));
    }
  }
}

/// The differing fluents that came as the model says, but at a later step.
std::vector<EditScope::Step::Late> late_changes(const RunParting& parting, const Evidence& seen) {
  std::vector<EditScope::Step::Late> out;
  auto waiting = parting.seen;
  for (std::size_t by = 1; by <= kLatestChange && parting.after + by < seen.states.size(); ++by) {
    EditScope::Step::Late step{seen.steps[parting.after + by - 1].event, by, {}};
    const auto& state = seen.states[parting.after + by];
    std::erase_if(waiting, [&](const auto& fluent) {
      const auto found = state.find(fluent.first);
      const bool came = found != state.end() && found->second != fluent.second;
      if (came) step.fluents.insert(fluent.first);
      return came;
    });
    if (!step.fluents.empty()) out.push_back(std::move(step));
  }
  return out;
}

EditScope::Step step_of(const RunParting& parting, const Evidence& seen) {
  EditScope::Step step;
  step.event = parting.step.event;
  step.refused = parting.step.failed;
  step.not_possible = says_not_possible(parting.step.reason);
  step.before = seen.states[parting.after - 1];
  step.differing = parting.seen;
  step.after = seen.states[parting.after];
  step.late = late_changes(parting, seen);
  return step;
}

}  // namespace

EditScope edit_scope(const RepairInput& input, ScopeReach reach) {
  EditScope out;
  for (const auto& form : input.domain->forms) {
    if (form.kind == compiler::AxiomForm::Kind::kTrigger) out.demanded.insert(form.event_symbol);
  }
  // They are in no recording: any of them may have happened at the step.
  out.more_events = out.demanded;
  out.idle = idle_events(input, out.demanded);
  out.wide = reach != ScopeReach::kPartings;
  for (const auto& parting : input.partings) {
    const auto& seen =
        *std::find_if(input.evidence.begin(), input.evidence.end(),
                      [&](const auto& each) { return each.ids.front() == parting.ids.front(); });
    out.steps.push_back(step_of(parting, seen));
    if (!out.wide) continue;
    const auto last = reach == ScopeReach::kWholeRuns ? seen.steps.size() : parting.after;
    for (std::size_t t = 0; t < last; ++t) {
      out.more_events.insert(base::symbol_of(seen.steps[t].event));
    }
  }
  for (const auto& seen : input.evidence) {
    add_changed(seen, out);
    add_successes(seen, out);
  }
  if (!out.wide) return out;
  // The mistake may be in any fluent that the axioms of the earlier steps mention.
  for (const auto& symbol : input.domain->typed->symbols) {
    if (symbol.kind == compiler::SymbolKind::kFluent && !symbol.noninertial) {
      out.more_fluents.insert(symbol.name);
    }
  }
  return out;
}

}  // namespace parallax::tools
