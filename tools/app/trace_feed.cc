#include "tools/app/trace_feed.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/words.h"
#include "harness/campaign/loop_stream.h"
#include "harness/region/state_mapping.h"
#include "runtime/enumerate/demanded_events.h"
#include "runtime/explain/contradiction.h"
#include "runtime/session/solver_session.h"
#include "tools/app/trace_writer.h"

namespace parallax::tools {

namespace {

/// Was the contradiction between these origins' axioms checked by a proof?
std::string proof_remark(const Context& context, const compiler::CompiledModel& model,
                         compiler::Timepoint steps, const std::vector<std::uint32_t>& core) {
  const auto axioms = runtime::group_axioms(model);
  std::set<std::uint32_t> groups;
  for (const auto origin : core) groups.insert(axioms.group_of[origin]);
  runtime::ExecutionFormula formula(model, runtime::Observed{steps, {}});
  runtime::ProofLimits limits;
  limits.stop = &context.stop();
  runtime::Effort none(0);  // the proof may stand on more than it needs
  const auto ground =
      runtime::ground_contradiction(formula, axioms, {groups.begin(), groups.end()}, limits, none);
  if (ground.proof.verdict == runtime::ProofVerdict::kAccepted) {
    return "a proof of the contradiction was checked";
  }
  return "no proof of the contradiction was accepted: " + ground.proof.reason;
}

/// Number of notes with places in the contradiction; a screen has no room for more.
constexpr std::size_t kMostBlamed = 6;

/// The parts of a contradiction: statements of the author first, then consequences of declarations;
/// within a kind in the order of the core.
std::vector<const compiler::Origin*> blamed_origins(const compiler::CompiledModel& model,
                                                    const std::vector<std::uint32_t>& core) {
  std::vector<const compiler::Origin*> blamed;
  // Several origins can share a place (the frame axiom and the declaration of a fluent).
  for (const auto index : core) {
    const auto* origin = &model.origins[index];
    const bool again = std::any_of(blamed.begin(), blamed.end(), [&](const auto* other) {
      return other->kind == origin->kind && other->source == origin->source;
    });
    if (!again) blamed.push_back(origin);
  }
  const auto rank = [](const compiler::Origin* origin) {
    using Kind = compiler::OriginKind;
    if (origin->kind == Kind::kAxiom || origin->kind == Kind::kStateConstraint) return 0;
    if (origin->kind == Kind::kPlanStep) return 1;
    return origin->kind == Kind::kEffectAxiom || origin->kind == Kind::kTrajectoryAxiom ? 2 : 3;
  };
  std::stable_sort(blamed.begin(), blamed.end(),
                   [&](const auto* a, const auto* b) { return rank(a) < rank(b); });
  return blamed;
}

/// "and 17 more take part (effect axiom: 9, frame axiom: 8): ...".
std::string further_text(const std::vector<const compiler::Origin*>& further) {
  std::vector<std::pair<std::string_view, std::size_t>> kinds;
  for (const auto* origin : further) {
    const auto name = to_string(origin->kind);
    const auto found = std::find_if(kinds.begin(), kinds.end(),
                                    [&](const auto& kind) { return kind.first == name; });
    if (found == kinds.end()) {
      kinds.emplace_back(name, 1);
    } else {
      ++found->second;
    }
  }
  std::string list;
  for (const auto& [name, count] : kinds) {
    list += fmt::format("{}{}: {}", list.empty() ? "" : ", ", name, count);
  }
  return fmt::format("and {} more take part ({}): `parallax explain` lists all of them",
                     further.size(), list);
}

}  // namespace

base::Known report_if_unsatisfiable(const compiler::CompiledModel& model, compiler::Timepoint steps,
                                    Context& context, const std::vector<std::string>& unexplored) {
  const auto core =
      runtime::find_unsat_core(model, steps, runtime::make_cadical_solver(&context.stop()));
  if (core.status != runtime::SolveStatus::kUnsatisfiable) return runtime::possible(core.status);
  const auto blamed = blamed_origins(model, core.origins);
  const auto first = blamed.empty() ? base::SourceRange{} : blamed.front()->source;
  auto diagnostic = context.sink().error(codes::kModelUnsatisfiable, first, steps);
  const auto shown = std::min(blamed.size(), kMostBlamed);
  for (std::size_t i = 0; i < shown; ++i) {
    diagnostic.note(blamed[i]->source,
                    fmt::format("this {} takes part", to_string(blamed[i]->kind)));
  }
  if (shown < blamed.size()) {
    diagnostic.note(
        further_text({blamed.begin() + static_cast<std::ptrdiff_t>(shown), blamed.end()}));
  }
  for (std::size_t i = 0; i < unexplored.size() && i < kMostBlamed; ++i) {
    diagnostic.note(unexplored[i]);
  }
  diagnostic.note(unexplored.empty()
                      ? proof_remark(context, model, steps, core.origins)
                      : "nothing is proved: the plan may have executions that were not explored");
  if (!core.is_minimal) diagnostic.note("stopped: not every one of them may be needed");
  return base::Known::kNo;
}

EnumeratedTraces::EnumeratedTraces(const compiler::CompiledModel& model, Context& context,
                                   const runtime::PlanEnumeratorOptions& options)
    : model_(&model),
      context_(&context),
      split_initial_(options.split_initial),
      session_(std::make_unique<runtime::SolverSession>(
          model, runtime::make_cadical_solver(&context.stop()))) {
  runtime::require_reasons(*session_);
  enumerator_ = std::make_unique<runtime::PlanEnumerator>(*session_, options);
}

EnumeratedTraces::EnumeratedTraces(const ScenarioModel& loaded, Context& context,
                                   const runtime::PlanEnumeratorOptions& options)
    : EnumeratedTraces(loaded.compilation.model, context, options) {
  reservations_ = reservations_of(loaded.compilation.plan);
  gaps_ = gap_texts(loaded.compilation.plan, context);
  if (loaded.scenario.initial == harness::Initial::kWeights) loaded_ = &loaded;
  if (loaded.scenario.mapping) unreached_.emplace(loaded);
}

base::Result<std::optional<harness::CampaignTrace>> EnumeratedTraces::next() {
  while (true) {
    auto trace = next_trace();
    if (!trace || loaded_ == nullptr) return trace;
    if (!*trace) return end_of_weights() ? trace : context_->sink().already_reported();
    const auto weighs = has_weight(**trace);
    if (!weighs) return context_->sink().already_reported();
    if (*weighs) return trace;
  }
}

/// Has one of the trace's initial states a weight above 0?
base::Result<bool> EnumeratedTraces::has_weight(const harness::CampaignTrace& trace) {
  const harness::ModelFluents known(*trace.symbols);
  auto fluents = harness::compared_fluents(loaded_->scenario, known);
  std::sort(fluents.begin(), fluents.end());
  std::vector<std::vector<compiler::FluentId>> states;
  if (split_initial_ || trace.other_initial_states == base::Known::kNo) {
    auto& own = states.emplace_back();
    for (const auto fluent : fluents) {
      if (runtime::contains(trace.points.front().holds, fluent)) own.push_back(fluent);
    }
  } else {
    auto found = enumerator_->initial_states(trace, fluents, harness::kMostInitialStates);
    if (found.stopped || found.more) return true;  // `starts` tells
    states = std::move(found.states);
  }
  const auto weights = weights_of(states, fluents);
  if (!weights) return context_->sink().already_reported();
  weighed_.insert(weights->held.begin(), weights->held.end());
  const bool any = !weights->are_all_zero();
  ++(any ? with_weight_ : without_weight_);
  if (!any) states_without_weight_ += states.size();
  return any;
}

/// Called after the last trace.
base::Status EnumeratedTraces::end_of_weights() {
  if (std::exchange(weights_told_, true)) return base::Unit{};
  if (without_weight_ > 0 && with_weight_ == 0) {
    return report_no_weight(*loaded_, states_without_weight_, *context_);
  }
  if (without_weight_ > 0) {
    context_->remark(
        fmt::format("{} left out, as `start_weights` gives each of {} initial states the weight 0",
                    base::counted(without_weight_, "trace is", "traces are"),
                    base::agreed(without_weight_, "its", "their")));
  }
  if (enumerator_->exploration() != runtime::Exploration::kStopped) {
    note_idle_weights(*loaded_, weighed_, *context_);
  }
  return base::Unit{};
}

base::Result<StateWeights> EnumeratedTraces::weights_of(
    const std::vector<std::vector<compiler::FluentId>>& states,
    const std::vector<compiler::FluentId>& told_by) {
  const auto value = [&](const std::string& predicate) {
    return runtime::predicate_value(*session_, predicate);
  };
  return start_weights(*loaded_, states, told_by, value, *context_);
}

/// Does nothing happen in it that is neither performed nor demanded?
base::Known EnumeratedTraces::is_closed(const harness::CampaignTrace& trace) {
  const auto& points = trace.points;
  const bool several = std::any_of(points.begin(), points.end(),
                                   [](const auto& point) { return point.happens.size() > 1; });
  if (!several) return base::Known::kYes;
  if (!closed_world_) {
    closed_world_.emplace(*model_, runtime::make_cadical_solver(&context_->stop()));
  }
  std::vector<std::string> performed;
  for (std::size_t t = 0; t < trace.event_count(); ++t) performed.push_back(trace.event(t));
  return closed_world_->admits(trace, performed);
}

base::Result<std::optional<harness::CampaignTrace>> EnumeratedTraces::next_trace() {
  constexpr std::optional<harness::CampaignTrace> kNone;
  for (;;) {
    auto trace = enumerator_->next();
    const bool is_stopped = enumerator_->exploration() == runtime::Exploration::kStopped;
    if (trace && (trace->other_initial_states == base::Known::kUndecided ||
                  trace->other_outcomes == base::Known::kUndecided)) {
      // The solver was stopped: nothing would be simulated, and the caveats are not known.
      return kNone;
    }
    if (!trace) {
      if (given_ == 0 && !is_stopped && !explain_absence()) {
        return context_->sink().already_reported();
      }
      return kNone;
    }
    trace->number = given_ + 1;
    auto converted = campaign_trace(*model_, *std::move(trace), *context_);
    if (!converted) return context_->sink().already_reported();
    const auto closed = is_closed(*converted);
    if (closed == base::Known::kUndecided) return kNone;
    if (closed == base::Known::kNo) continue;
    given_ = converted->number;
    if (unreached_) unreached_->note(*converted);
    // Traces with the same events are distinguished by their initial states.
    if (split_initial_) {
      converted->key += fmt::format(" from {}", fmt::join(converted->holds(0), ";"));
    }
    return std::optional<harness::CampaignTrace>(*std::move(converted));
  }
}

std::string EnumeratedTraces::exploration() const {
  auto found = enumerator_->exploration();
  const bool is_all = found == runtime::Exploration::kAllTracesExplored;
  if (is_all && reservations_.any()) found = runtime::Exploration::kCompleteUpToBound;
  return std::string(runtime::to_string(found));
}

std::string EnumeratedTraces::reservation() const {
  auto out = reservations_;
  out.cut = !enumerator_->open_ends().cuts.empty();
  return out.words();
}

std::vector<std::string> EnumeratedTraces::bounds() const {
  auto out = gaps_;
  for (auto& text : open_end_texts(*model_, enumerator_->open_ends())) {
    out.push_back(std::move(text));
  }
  const auto left_out = weightless_ + static_cast<std::int64_t>(states_without_weight_);
  if (left_out > 0) {
    auto text = fmt::format("{} not simulated, as `start_weights` gives {} the weight 0",
                            base::counted(left_out, "initial state is", "initial states are"),
                            base::agreed(left_out, "it", "them"));
    if (without_weight_ > 0) {
      text += fmt::format("; with {} not simulated at all",
                          base::counted(without_weight_, "trace", "traces"));
    }
    out.push_back(std::move(text));
  }
  if (!unreached_) return out;
  for (auto& text : unreached_->texts(*context_)) out.push_back(std::move(text));
  return out;
}

base::Known EnumeratedTraces::admits(
    const harness::CampaignTrace& trace,
    const std::vector<std::map<compiler::FluentId, bool>>& observed) {
  PARALLAX_REQUIRE(trace.number <= given_, "a trace that was given is asked about");
  const auto told_by = told_by_.find(trace.number);
  return enumerator_->admits(trace, observed,
                             told_by == told_by_.end() ? nullptr : &told_by->second);
}

base::Result<std::optional<harness::TraceStarts>> EnumeratedTraces::starts(
    const harness::CampaignTrace& trace, std::span<const compiler::FluentId> fluents) {
  auto found = enumerator_->initial_states(trace, fluents, harness::kMostInitialStates);
  if (found.stopped) return std::optional<harness::TraceStarts>();
  harness::TraceStarts out;
  out.more = found.more;
  std::vector<compiler::FluentId> own;
  for (const auto fluent : fluents) {
    if (runtime::contains(trace.points.front().holds, fluent)) own.push_back(fluent);
  }
  out.states.push_back(own);
  std::vector<compiler::FluentId> told_by(fluents.begin(), fluents.end());
  if (found.more) {
    auto parts = enumerator_->initial_parts(trace, fluents, harness::kMostInitialStates);
    if (!parts) return std::optional<harness::TraceStarts>();
    out.parts = *std::move(parts);
  } else {
    for (const auto& state : found.states) {
      if (state != own) out.states.push_back(state);
    }
  }
  if (unreached_ && !found.more) unreached_->note(trace.number, found.states);
  if (loaded_ != nullptr && !weigh(out, told_by)) return context_->sink().already_reported();
  if (out.more || out.states.size() > 1 || out.states.front() != own) {
    told_by_[trace.number] = std::move(told_by);
  }
  return std::optional(std::move(out));
}

/// Gives the states their weights, and leaves out those that have none.
base::Status EnumeratedTraces::weigh(harness::TraceStarts& starts,
                                     const std::vector<compiler::FluentId>& told_by) {
  if (starts.more) {
    return context_->sink().error(codes::kTooManyInitialStates,
                                  loaded_->scenario.start_weights_source,
                                  harness::kMostInitialStates);
  }
  const auto weights = weights_of(starts.states, told_by);
  if (!weights) return context_->sink().already_reported();
  auto states = std::move(starts.states);
  starts.states.clear();
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (weights->weights[i] == 0.0) {
      ++weightless_;
      continue;
    }
    starts.states.push_back(std::move(states[i]));
    starts.weights.push_back(weights->weights[i]);
  }
  return base::Unit{};
}

base::Result<std::pair<base::Known, std::optional<harness::CampaignTrace>>> EnumeratedTraces::from(
    const harness::CampaignTrace& trace, std::span<const compiler::FluentId> fluents,
    const std::vector<compiler::FluentId>& state) {
  auto found = enumerator_->from(trace, fluents, state);
  if (!found.trace) return std::pair(found.exists, std::optional<harness::CampaignTrace>());
  auto converted = campaign_trace(*model_, *std::move(found.trace), *context_);
  if (!converted) return context_->sink().already_reported();
  converted->key = trace.key;
  return std::pair(base::Known::kYes, std::optional(*std::move(converted)));
}

/// Called when the search is exhausted: it is proved that no trace meets the constraints.
base::Status EnumeratedTraces::explain_absence() const {
  auto& sink = context_->sink();
  auto unexplored = gaps_;
  for (auto& text : open_end_texts(*model_, {enumerator_->open_ends().cuts, {}})) {
    unexplored.push_back(std::move(text));
  }
  if (report_if_unsatisfiable(*model_, model_->horizon, *context_, unexplored) ==
      base::Known::kNo) {
    return sink.already_reported();
  }
  auto reasons = reasons_ ? reasons_() : std::vector<std::string>();
  reasons.insert(reasons.end(), unexplored.begin(), unexplored.end());
  for (const auto& origin : model_->origins) {
    if (origin.kind != compiler::OriginKind::kStateConstraint) continue;
    auto warning = sink.warning(codes::kNoTraceReachesConstraint, origin.source, model_->horizon);
    for (const auto& reason : reasons) warning.note(reason);
  }
  return base::Unit{};
}

namespace {

/// The one of several events that is performed: that of the plan's step, else the only one that no
/// axiom can demand. Empty: there is none, or there are several.
std::string performed_event(const compiler::CompiledModel& model,
                            const runtime::TracePoint& point) {
  const auto demandable = runtime::demandable_events(model);
  std::vector<std::string> performed;
  for (const auto event : point.happens) {
    const auto& name = model.events[event.index()].name;
    const bool planned = point.plan_step && model.plan[*point.plan_step].event == name;
    if (planned || !runtime::contains(demandable, event)) performed.push_back(name);
  }
  return performed.size() == 1 ? performed.front() : std::string();
}

}  // namespace

base::Result<harness::CampaignTrace> campaign_trace(const compiler::CompiledModel& model,
                                                    runtime::Trace trace, Context& context) {
  harness::CampaignTrace out{std::move(trace), {}, {}};
  out.key = runtime::event_key(out);
  for (std::size_t t = 0; t + 1 < out.points.size(); ++t) {
    const auto& point = out.points[t];
    auto& planned = out.plan.emplace_back();
    if (point.happens.size() != 1) {
      const auto performed = performed_event(model, point);
      if (performed.empty()) {
        const auto where = model.origins.front().source;
        return context.sink().error(codes::kSeveralEventsAtOnce, where, point.happens.size(), t);
      }
      planned.event = performed;
    }
    if (!point.plan_step) continue;
    const auto& step = model.plan[*point.plan_step];
    planned.source = context.files().place(step.source);
    for (const auto& [name, value] : step.arguments) {
      std::visit([&, key = name](const auto& v) { planned.arguments[key] = v; }, value);
      // An object that the plan knows from the model is named by its register.
      if (const auto* text = std::get_if<std::string>(&value)) {
        const auto known = point.registers.find(*text);
        if (known != point.registers.end()) planned.arguments[name] = known->second;
      }
    }
  }
  return out;
}

}  // namespace parallax::tools
