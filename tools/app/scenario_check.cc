#include "tools/app/scenario_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/scenarios.h"
#include "compiler/sema/typed_model.h"
#include "harness/campaign/campaign.h"
#include "harness/campaign/loop_stream.h"
#include "harness/campaign/start_check.h"
#include "harness/config/scenario.h"
#include "harness/discrete/model_simulator.h"
#include "harness/robot/ode_simulator.h"
#include "harness/world/grip_limits.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "tools/app/closed_loop.h"
#include "tools/app/open_starts.h"
#include "tools/app/trace_feed.h"

namespace parallax::tools {
namespace {

using compiler::TermKind;
using harness::GroundFluent;

/// The arguments of variables, by the text of a ground term that a pattern was matched with.
class Matcher {
 public:
  explicit Matcher(const compiler::TypedModel& model) : model_(model) {}

  /// Can the term be this ground one, given what its variables are? Terms that compute are taken
  /// for anything.
  bool match(const compiler::Term& pattern, const GroundFluent& ground) {
    if (pattern.arguments.size() != ground.arguments.size()) return false;
    for (std::size_t i = 0; i < ground.arguments.size(); ++i) {
      const auto& argument = model_.terms[pattern.arguments[i]];
      const auto& text = ground.arguments[i];
      if (argument.kind == TermKind::kVariable) {
        if (values_.emplace(argument.variable.index(), text).first->second != text) return false;
      } else if (const auto fixed = text_of(argument); fixed && *fixed != text) {
        return false;
      }
    }
    return true;
  }

 private:
  std::optional<std::string> text_of(const compiler::Term& term) const {
    if (term.kind == TermKind::kObject) return model_.objects[term.object].name;
    if (term.kind == TermKind::kInteger) return std::to_string(term.integer);
    return std::nullopt;
  }

  const compiler::TypedModel& model_;
  std::map<std::size_t, std::string> values_;  // by variable
};

/// The ground fluents that ground events initiate and terminate by the model's effect axioms,
/// whatever the conditions. Only of events whose symbol `is_asked` accepts.
std::vector<harness::CausedFluent> caused_fluents(
    const compiler::TypedModel& model, const std::vector<GroundFluent>& events,
    const std::vector<GroundFluent>& fluents,
    const std::function<bool(const std::string&)>& is_asked) {
  std::map<std::string, std::vector<const GroundFluent*>> by_symbol;
  for (const auto& fluent : fluents) by_symbol[fluent.symbol].push_back(&fluent);
  std::vector<harness::CausedFluent> out;
  for (const compiler::EffectAxiom& effect : model.effects) {
    const auto &event = model.terms[effect.event], &fluent = model.terms[effect.fluent];
    const bool named = event.kind == TermKind::kApply && fluent.kind == TermKind::kApply;
    if (!named || effect.kind == compiler::EffectKind::kReleases) continue;
    const auto& event_symbol = model.symbols[event.symbol].name;
    if (!is_asked(event_symbol)) continue;
    for (const auto& happens : events) {
      if (happens.symbol != event_symbol) continue;
      Matcher matched(model);
      if (!matched.match(event, happens)) continue;
      for (const auto* holds : by_symbol[model.symbols[fluent.symbol].name]) {
        Matcher both = matched;
        if (!both.match(fluent, *holds)) continue;
        out.push_back({happens, *holds, effect.kind == compiler::EffectKind::kInitiates});
      }
    }
  }
  return out;
}

using compiler::SymbolId;
using compiler::TermKind;

// The first traces of a campaign, with the seed that it has where none is given.
constexpr std::int64_t kTracesTried = 10;
constexpr std::size_t kStatesTried = 10;  // initial states of each
constexpr std::uint64_t kSeedTried = 1;

/// The fluents that a formula names.
std::set<SymbolId> fluents_named(const std::string& formula, const compiler::TypedModel& model) {
  std::set<SymbolId> found;
  for (std::size_t i = 0; i < formula.size();) {
    if (!base::is_name_character(formula[i])) {
      ++i;
      continue;
    }
    const auto begin = i;
    while (i < formula.size() && base::is_name_character(formula[i])) ++i;
    const auto symbol = model.find_symbol(std::string_view(formula).substr(begin, i - begin));
    if (symbol && model.symbols[*symbol].kind == compiler::SymbolKind::kFluent) {
      found.insert(*symbol);
    }
  }
  return found;
}

/// Can one of these events change the fluent, by an effect or by what a trajectory says?
bool is_changed(const compiler::TypedModel& model, SymbolId fluent,
                const std::set<std::string>& events) {
  if (model.symbols[fluent].noninertial) return true;
  const auto names = [&](compiler::TermId id, const auto& fits) {
    const auto& term = model.terms[id];
    return term.kind != TermKind::kApply || fits(term.symbol);
  };
  const auto is_fluent = [&](SymbolId symbol) { return symbol == fluent; };
  const auto is_event = [&](SymbolId symbol) {
    return events.contains(model.symbols[symbol].name);
  };
  const bool by_effect = std::any_of(
      model.effects.begin(), model.effects.end(), [&](const compiler::EffectAxiom& effect) {
        return names(effect.fluent, is_fluent) && names(effect.event, is_event);
      });
  return by_effect ||
         std::any_of(model.trajectories.begin(), model.trajectories.end(),
                     [&](const auto& trajectory) { return names(trajectory.target, is_fluent); });
}

/// The number of events of a shortest trace within the horizon, if there is one.
std::optional<std::size_t> shortest_trace(const compiler::CompiledModel& model, Context& context) {
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  runtime::PlanEnumerator enumerator(session, {.order = runtime::TraceOrder::kAny});
  const auto trace = enumerator.next();
  if (!trace) return std::nullopt;
  return trace->points.size() - 1;
}

/// How far to look for a trace that the horizon cuts off.
std::int64_t far_horizon(std::int64_t horizon, const std::optional<compiler::PlanGraph>& plan) {
  constexpr std::int64_t kFarthest = 100, kFurther = 20;
  const auto far = std::min(std::max(3 * horizon, horizon + kFurther), kFarthest);
  const auto longest = plan ? compiler::longest_path(*plan) : std::nullopt;
  return longest ? std::min(far, *longest) : far;
}

}  // namespace

std::vector<std::string> reasons_for_absence(const ScenarioModel& loaded, Context& context) {
  const auto& scenario = loaded.scenario;
  const auto& plan = loaded.compilation.plan;
  const auto& typed = *loaded.compilation.typed;
  std::vector<std::string> reasons;
  std::set<std::string> events;
  if (plan) {
    for (const auto& location : plan->locations) events.insert(location.event_symbol);
    std::set<SymbolId> needed;
    for (const auto& constraint : scenario.constraints) {
      needed.merge(fluents_named(constraint.text, typed));
    }
    for (const auto fluent : needed) {
      if (is_changed(typed, fluent, events)) continue;
      reasons.push_back(
          fmt::format("no event that the plan performs has an effect on `{}`, which they speak of",
                      typed.symbols[fluent].name));
    }
    const auto shortest = compiler::shortest_path(*plan);
    if (shortest && *shortest > scenario.horizon) {
      reasons.push_back(
          fmt::format("the shortest way through the plan takes {} performs", *shortest));
    }
  }
  const auto far = far_horizon(scenario.horizon, plan);
  if (far > scenario.horizon) {
    const auto longer = compile_variant(scenario, far, true, context);
    const auto length = longer ? shortest_trace(*longer, context) : std::nullopt;
    if (length) {
      reasons.push_back(fmt::format("a horizon of {} is long enough", *length));
      return reasons;
    }
    if (longer && !context.stopped()) {
      reasons.push_back(fmt::format("a horizon of {} is not long enough either", far));
    }
  }
  if (!plan || context.stopped()) return reasons;
  const auto unplanned = compile_variant(scenario, scenario.horizon, false, context);
  if (unplanned && !shortest_trace(*unplanned, context) && !context.stopped()) {
    reasons.push_back(fmt::format(
        "no state that {} timepoints of any events lead to meets them, whatever the plan does",
        scenario.horizon));
  }
  return reasons;
}

namespace {

/// The simulator that a scenario is tried with; null: it would have to be started.
std::unique_ptr<harness::Simulator> tried_simulator(const ScenarioModel& loaded, Context& context) {
  const auto& scenario = loaded.scenario;
  if (scenario.simulator.is_built_in()) {
    return std::make_unique<harness::OdeSimulator>(scenario.world);
  }
  if (loaded.world) {
    return std::make_unique<harness::ModelSimulator>(loaded.world, &context.stop());
  }
  context.remark("the simulator was not started: what it observes and takes is not checked");
  return nullptr;
}

/// The ground symbols of a model, taken apart.
template <typename Named>
std::vector<harness::GroundFluent> ground_of(const Named& all) {
  std::vector<harness::GroundFluent> out;
  for (const auto& one : all) out.push_back(harness::ground_fluent(one.name));
  return out;
}

/// Fluents that the events of a trace cause, with the arguments that the plan gives them.
std::vector<harness::CausedFluent> planned_fluents(
    const harness::CampaignTrace& trace, const std::vector<harness::CausedFluent>& caused) {
  std::vector<harness::CausedFluent> out;
  for (std::size_t t = 0; t < trace.event_count(); ++t) {
    if (trace.plan[t].arguments.empty()) continue;
    for (const auto& one : caused) {
      if (one.event.text != trace.event(t)) continue;
      out.push_back(one);
      out.back().planned = trace.plan[t].arguments;
    }
  }
  return out;
}

/// Checks a plan that is to be executed: its conditions and performs, and its initial states.
void check_before_executions(const ScenarioModel& loaded, Context& context) {
  auto& sink = context.sink();
  const auto& scenario = loaded.scenario;
  if (scenario.criterion.kind == harness::CriterionKind::kPaper) {
    sink.error(codes::kCriterionNotOfLoop, base::SourceRange{scenario.source, 0, 0});
    return;
  }
  harness::warn_of_low_limit(scenario, context.files(), sink);
  const auto loop = ClosedLoop::make(loaded, context);
  if (!loop || !harness::check_performs(scenario, (*loop)->plan(), sink)) return;
  const harness::ModelFluents fluents(*(*loop)->symbols());
  auto states = (*loop)->initial_states(harness::compared_fluents(scenario, fluents));
  if (!states || !*states) return;
  UnrealisableStarts unrealisable(loaded, fluents, context);
  unrealisable.look(**states, *(*loop)->symbols());
  unrealisable.report();
  const auto simulator = tried_simulator(loaded, context);
  const auto info = simulator ? simulator->info() : harness::SimulatorInfo();
  for (std::size_t i = 0; i < (*states)->holds.size() && !context.stopped(); ++i) {
    const auto state = harness::LoopStream::start_state(**loop, (*states)->holds[i]);
    const auto errors_before = sink.error_count();
    const auto prepared = harness::prepare_trace(scenario, fluents.ground(), info, *state, sink);
    if (prepared && simulator && i < kStatesTried) {
      harness::check_first_start(
          scenario, *state, *prepared, fluents, kSeedTried, *simulator,
          [&] { return context.stopped(); }, sink);
    }
    if (sink.error_count() != errors_before) return;
  }
}

/// Where engine, step and the form of what is gripped are known to let it slip.
void warn_of_grips(const harness::Scenario& scenario, base::DiagnosticSink& sink) {
  if (!scenario.simulator.is_built_in()) return;
  const auto& world = scenario.world;
  std::map<std::string, harness::GripRange> ranges;
  for (const auto& body : world.bodies) {
    auto& range = ranges[body.name];
    for (const auto& [variable, interval] : scenario.sampling) {
      if (variable != body.name + ".mass") continue;
      range.lightest_kg = interval.lower;
      range.heaviest_kg = interval.upper;
    }
  }
  for (const auto& action : scenario.actions) {
    harness::widen_by_action(world, action.controller, action.arguments, ranges);
  }
  constexpr double kMs = 1000.0;
  for (const auto& grip : harness::doubtful_grips(world, ranges)) {
    const auto at = scenario.body_sources.find(grip.body);
    const auto& place =
        at != scenario.body_sources.end() ? at->second : base::SourceRange{scenario.source, 0, 0};
    const auto other = world.engine == harness::EngineKind::kOde ? harness::EngineKind::kMujoco
                                                                 : harness::EngineKind::kOde;
    auto warning = sink.warning(codes::kDoubtfulGrip, place, kMs * world.solver.timestep_s,
                                to_string(world.engine), grip.body, to_string(grip.form),
                                grip.slipped, grip.runs, kMs * grip.measured_s);
    warning.help(fmt::format(
        "Write `world: {{solver: {{timestep_s: {:g}}}}}`, at which none slipped, or `simulator: "
        "{{engine: {}}}`: what slips here is the solver's doing, not the model's "
        "(docs/internals/physics.md, \"Grips\").",
        grip.sound_s, to_string(other)));
  }
}

/// Prepares the first traces as a run does, and puts the built-in simulator into a start of each of
/// their first initial states.
void check_first_traces(const ScenarioModel& loaded, EnumeratedTraces& traces,
                        const harness::ModelFluents& fluents,
                        const std::vector<harness::CausedFluent>& caused,
                        UnrealisableStarts& unrealisable, Context& context) {
  auto& sink = context.sink();
  const auto& scenario = loaded.scenario;
  const auto simulator = tried_simulator(loaded, context);
  const auto info = simulator ? simulator->info() : harness::SimulatorInfo();
  std::set<std::string> tried;  // starts; most traces share theirs
  const auto last = scenario.limits.max_traces > 0
                        ? std::min(scenario.limits.max_traces, kTracesTried)
                        : kTracesTried;
  for (std::int64_t number = 0; number < last && !context.stopped(); ++number) {
    auto given = traces.next();
    if (!given || !*given) return;
    const auto from = unrealisable.look(**std::move(given), traces, kStatesTried);
    if (!from) return;
    for (const auto& trace : *from) {
      const auto prepared = harness::prepare_trace(scenario, fluents.ground(), info, trace, sink);
      if (!prepared) return;
      const auto errors_before = sink.error_count();
      harness::check_stops(scenario, planned_fluents(trace, caused), sink);
      if (sink.error_count() != errors_before) return;
      if (!simulator || !tried.insert(fmt::format("{}", fmt::join(trace.holds(0), ";"))).second) {
        continue;
      }
      harness::check_first_start(
          scenario, trace, *prepared, fluents, kSeedTried, *simulator,
          [&] { return context.stopped(); }, sink);
      if (sink.error_count() != errors_before) return;
    }
  }
}

}  // namespace

void check_before_run(const ScenarioModel& loaded, Context& context) {
  auto& sink = context.sink();
  const auto& scenario = loaded.scenario;
  warn_of_grips(scenario, sink);
  const auto& model = loaded.compilation.model;
  std::vector<harness::CausedFluent> caused;
  if (scenario.simulator.is_built_in() && scenario.mapping && loaded.compilation.typed) {
    const auto errors_before = sink.error_count();
    caused = caused_fluents(
        *loaded.compilation.typed, ground_of(model.events), ground_of(model.fluents),
        [&](const std::string& event) { return harness::leads_to_stop(scenario, event); });
    harness::check_stops(scenario, caused, sink);
    if (sink.error_count() != errors_before) return;
  }
  report_open_starts(loaded, context);
  if (scenario.execution == harness::Execution::kClosedLoop) {
    return check_before_executions(loaded, context);
  }
  if (!model.has_constraints) {
    sink.error(codes::kNothingToSimulate, base::SourceRange{scenario.source, 0, 0});
    return;
  }
  harness::warn_of_low_limit(scenario, context.files(), sink);
  EnumeratedTraces traces(loaded, context);
  traces.explain_absence_by([&] { return reasons_for_absence(loaded, context); });
  const harness::ModelFluents fluents(*traces.symbols());
  UnrealisableStarts unrealisable(loaded, fluents, context);
  check_first_traces(loaded, traces, fluents, caused, unrealisable, context);
  unrealisable.report();
}

}  // namespace parallax::tools
