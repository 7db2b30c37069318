#include "tools/app/watch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/file_io.h"
#include "compiler/base/ground_name.h"
#include "compiler/base/suggest.h"
#include "compiler/plan/plan_binding.h"
#include "compiler/plan/plan_graph.h"
#include "runtime/enumerate/demanded_events.h"
#include "tools/app/plan_reservations.h"

namespace parallax::tools {
namespace {

using compiler::CompiledModel;
using compiler::EventId;
using runtime::Admission;
using runtime::StepWindows;

/// Limit on the timepoints that a model is compiled for beyond those of its scenario, so that
/// repetition is detected.
constexpr std::int64_t kMostTimepoints = 120;

/// The events of these symbols.
base::Result<std::vector<EventId>> events_of(const std::vector<std::string>& symbols,
                                             const CompiledModel& model, Context& context) {
  std::vector<std::string> known;
  for (const auto& event : model.events) known.push_back(base::symbol_of(event.name));
  std::vector<EventId> out;
  for (const auto& symbol : symbols) {
    bool found = false;
    for (std::uint32_t e = 0; e < known.size(); ++e) {
      if (known[e] != symbol) continue;
      found = true;
      out.emplace_back(e);
    }
    if (found) continue;
    auto error = context.sink().error_about(codes::kNoSuchEvent, "unobserved", symbol);
    if (const auto near = base::nearest_name(symbol, known)) {
      error.note(fmt::format("there is an event `{}`", *near));
    }
    return error;
  }
  return out;
}

/// The symbols of events that the plan's binding table names.
std::set<std::string> performable(const harness::Scenario& scenario) {
  std::set<std::string> out;
  if (!scenario.bind) return out;
  base::SourceFiles files;
  base::DiagnosticSink unread;  // it was read before
  const auto text = base::load_text(scenario.bind->text, files, unread);
  if (!text) return out;
  const auto binding = compiler::parse_plan_binding(files, *text, unread);
  if (!binding) return out;
  for (const auto& entry : binding->entries) {
    if (!entry.plan) out.insert(entry.event_symbol);
  }
  return out;
}

/// Events that somebody knows of: the plan performs them, or the log may be silent about them. The
/// rest happens only where axioms demand it.
void note_unseen(const harness::Scenario& scenario, const CompiledModel& model,
                 runtime::BeliefOptions& options) {
  if (scenario.plan.empty()) return;
  const auto symbols = performable(scenario);
  for (std::uint32_t e = 0; e < model.events.size(); ++e) {
    if (symbols.contains(base::symbol_of(model.events[e].name))) options.performed.emplace_back(e);
  }
  const auto is_in = [](const std::vector<EventId>& events, EventId event) {
    return std::find(events.begin(), events.end(), event) != events.end();
  };
  for (const auto event : runtime::demandable_events(model)) {
    if (is_in(options.performed, event) || is_in(options.unobserved, event)) continue;
    options.demanded.push_back(event);
  }
}

/// A horizon at which it shows that a plan is over, or comes round again.
std::int64_t wanted_horizon(const ScenarioModel& loaded) {
  const auto& plan = loaded.compilation.plan;
  const std::int64_t horizon = loaded.scenario.horizon;
  const auto longest = plan ? compiler::longest_path(*plan) : std::optional<std::int64_t>(0);
  return std::max<std::int64_t>(horizon, longest ? *longest + 3 : 2 * horizon);
}

}  // namespace

base::Result<std::unique_ptr<Watch>> Watch::make(const ScenarioModel& loaded,
                                                 const WatchOptions& options, Context& context) {
  auto& sink = context.sink();
  std::unique_ptr<Watch> out(new Watch());
  out->loaded_ = &loaded;
  out->context_ = &context;
  const bool has_plan = !loaded.scenario.plan.empty();
  std::vector<std::int64_t> horizons = {loaded.scenario.horizon};
  if (options.with_plan && has_plan) horizons.push_back(wanted_horizon(loaded));
  horizons.push_back(std::max<std::int64_t>(4, 2 * loaded.scenario.horizon));
  for (const auto horizon : horizons) {
    if (out->windows_ != nullptr &&
        (out->windows_->goes_on() || horizon > kMostTimepoints + loaded.scenario.horizon)) {
      break;
    }
    const CompiledModel* model = &loaded.compilation.model;
    std::optional<CompiledModel> compiled;
    if (horizon != loaded.scenario.horizon || (has_plan && !options.with_plan)) {
      compiled = compile_variant(loaded.scenario, horizon, options.with_plan && has_plan, context);
      if (!compiled && out->windows_ != nullptr) break;
      if (!compiled) {
        return sink.error_about(codes::kNoSteps, loaded.scenario.name,
                                "it cannot be compiled without its plan");
      }
      model = &*compiled;
    }
    auto made = runtime::step_windows(*model);
    if (const auto* why = std::get_if<std::string>(&made)) {
      if (out->windows_ != nullptr) break;
      return sink.error_about(codes::kNoSteps, loaded.scenario.name, *why);
    }
    out->windows_ = std::get<std::unique_ptr<StepWindows>>(std::move(made));
  }
  const auto& model = out->windows_->model;
  if (options.with_plan && has_plan && model.plan.empty()) {
    context.remark(
        "the plan performs nothing, so no event that the binding table names can happen; "
        "--no-plan asks the model alone");
  }
  auto names = loaded.scenario.unobserved;
  names.insert(names.end(), options.unobserved.begin(), options.unobserved.end());
  auto unobserved = events_of(names, model, context);
  if (!unobserved) return sink.already_reported();

  out->symbols_ = std::make_unique<compiler::SymbolTable>(model);
  out->fluents_.emplace(*out->symbols_);
  out->number_of_.resize(model.fluents.size());
  const auto& ground = out->fluents_->ground();
  for (std::size_t i = 0; i < ground.size(); ++i) {
    out->number_of_[out->fluents_->id(i).index()] = i;
  }
  const auto& mapping = *loaded.scenario.mapping;
  out->reader_ = std::make_unique<harness::ObservationReader>(mapping, ground);
  out->only_at_rest_ =
      options.comparison.value_or(loaded.scenario.comparison()) == harness::Comparison::kFinal;
  out->compares_at_rest_ =
      out->only_at_rest_ ||
      std::any_of(mapping.bindings().begin(), mapping.bindings().end(),
                  [](const harness::FluentBinding& binding) { return binding.at_rest_only; });
  out->tolerance_ = options.tolerance;
  runtime::BeliefOptions belief;
  belief.max_states = options.max_states;
  belief.remembered = 10 * options.max_states;
  belief.unobserved = *std::move(unobserved);
  belief.stop = &context.stop();
  note_unseen(loaded.scenario, model, belief);
  if (!options.with_plan) belief.performed.clear();
  out->belief_ = std::make_unique<runtime::Belief>(*out->windows_, belief);
  const auto gaps = gap_texts(loaded.compilation.plan, context);
  if (!options.with_plan || gaps.empty()) return out;
  out->gaps_ = fmt::format("the plan may have executions that were not explored ({})",
                           fmt::join(gaps, "; "));
  auto without_plan = options;
  without_plan.with_plan = false;
  const auto before = sink;
  auto axioms = Watch::make(loaded, without_plan, context);
  if (axioms) out->axioms_ = *std::move(axioms);
  sink = before;  // without it every refusal is undecided
  return out;
}

std::vector<std::string> Watch::event_names() const {
  return compiler::names_of(windows_->model.events);
}

void Watch::restart() {
  belief_->restart();
  refusal_ = {};
  tolerated_ = {};
  last_compared_ = false;
  unexplored_.clear();
  if (axioms_) axioms_->restart();
}

/// The values in the order in which the watch without the plan names its variables.
harness::ReportedValues Watch::for_axioms(const harness::ReportedValues& values) const {
  harness::ReportedValues out;
  const auto& known = reader_->variables();
  for (const auto& name : axioms_->reader_->variables()) {
    const auto found = std::find(known.begin(), known.end(), name);
    out.push_back(found == known.end() ? std::nullopt
                                       : values[static_cast<std::size_t>(found - known.begin())]);
  }
  return out;
}

Admission Watch::step_of_axioms(const runtime::ToldStep& told) {
  runtime::ToldStep by_name;
  for (const auto event : told.events) {
    const auto known = axioms_->symbols_->event(symbols_->name(event));
    if (!known) return Admission::kAdmitted;  // nothing is known of it
    by_name.events.push_back(*known);
  }
  std::sort(by_name.events.begin(), by_name.events.end());
  return axioms_->step(by_name);
}

/// A refusal counts where the axioms refuse, too, or every execution of the plan was explored.
Admission Watch::judged(Admission by_plan, Admission by_axioms) {
  if (by_plan != Admission::kRefused || gaps_.empty()) return by_plan;
  if (axioms_ && by_axioms == Admission::kRefused) {
    refusal_ = axioms_->refusal();
    return by_plan;
  }
  unexplored_ = gaps_;
  return Admission::kUndecided;
}

runtime::Observation Watch::observation_of(const harness::SeenState& seen) const {
  runtime::Observation out(seen.fluents.size(), 0);
  for (std::size_t i = 0; i < seen.fluents.size(); ++i) {
    out[fluents_->id(i).index()] = seen.fluents[i];
  }
  return out;
}

Admission Watch::observe(const harness::ReportedValues& values, bool at_rest) {
  last_compared_ = false;
  if (only_at_rest_ && !at_rest) return Admission::kAdmitted;
  reader_->read(values, at_rest, seen_, tolerance_);
  observation_ = observation_of(seen_);
  last_compared_ = seen_.in_no_state() || !seen_.one_of.empty() ||
                   std::any_of(seen_.fluents.begin(), seen_.fluents.end(),
                               [](std::int8_t known) { return known != 0; });
  if (last_compared_) ++compared_;
  if (!undecided_because().empty()) return Admission::kUndecided;
  const auto by_axioms =
      axioms_ ? axioms_->observe(for_axioms(values), at_rest) : Admission::kAdmitted;
  bool exact_agrees = true;
  if (seen_.near_border) {
    reader_->read(values, at_rest, exact_);
    exact_agrees = !exact_.in_no_state() && belief_->agrees(observation_of(exact_));
  }
  std::vector<runtime::OneOfFluents> one_of;
  for (const auto& numbers : seen_.one_of) {
    auto& fluents = one_of.emplace_back();
    for (const auto number : numbers) fluents.push_back(fluents_->id(number));
  }
  const auto admission =
      seen_.in_no_state() ? Admission::kRefused : belief_->observe(observation_, one_of);
  if (admission == Admission::kRefused) {
    explain(values, at_rest);
  } else if (seen_.near_border) {
    ++tolerated_.near_border;
    if (!exact_agrees) ++tolerated_.only_within;
  }
  return judged(admission, by_axioms);
}

RefusedFluent Watch::refused(std::size_t number, const harness::ReportedValues& values) const {
  RefusedFluent out;
  out.fluent = fluents_->ground()[number].text;
  for (const auto variable : reader_->variables_of(number)) {
    if (values[variable])
      out.variables.emplace_back(reader_->variables()[variable], *values[variable]);
  }
  return out;
}

/// An observation that is refused is refused without the tolerance as well; that says more where it
/// leaves open which of several fluents it is.
void Watch::explain(const harness::ReportedValues& values, bool at_rest) {
  refusal_ = {};
  explain_seen(values);
  if (!refusal_.fluents.empty() || tolerance_.is_exact()) return;
  reader_->read(values, at_rest, seen_);
  observation_ = observation_of(seen_);
  explain_seen(values);
}

void Watch::explain_seen(const harness::ReportedValues& values) {
  for (const auto number : seen_.neither) {
    refusal_.fluents.push_back(refused(number, values));
    refusal_.fluents.back().neither = true;
  }
  for (const auto& text : seen_.outside) {
    RefusedFluent outside;
    outside.fluent = text;
    outside.observed = true;
    // All fluents about the body are read from much the same variables.
    for (std::size_t i = 0; i < fluents_->ground().size() && outside.variables.empty(); ++i) {
      const auto& fluent = fluents_->ground()[i];
      if (loaded_->scenario.mapping->outside_text(fluent) != text) continue;
      outside.variables = refused(i, values).variables;
    }
    refusal_.fluents.push_back(std::move(outside));
  }
  if (!refusal_.fluents.empty()) return;
  for (const auto& [fluent, observed] : belief_->disagreement(observation_)) {
    refusal_.fluents.push_back(refused(number_of_[fluent.index()], values));
    refusal_.fluents.back().observed = observed;
  }
}

Admission Watch::step(const runtime::ToldStep& told) {
  if (!unexplored_.empty()) return Admission::kUndecided;
  const auto by_axioms = axioms_ ? step_of_axioms(told) : Admission::kAdmitted;
  const auto admission = belief_->step(told);
  if (admission != Admission::kRefused) return admission;
  refusal_ = {};
  for (const auto event : told.events) {
    if (!refusal_.event.empty()) refusal_.event += '+';
    refusal_.event += symbols_->name(event);
  }
  refusal_.only_outcome = told.succeeded && belief_->admits({told.events, std::nullopt});
  for (const auto step : belief_->plan_steps()) {
    const auto& performed = windows_->model.plan[step];
    const auto place = performed.place.file.empty()
                           ? context_->files().place(performed.source)
                           : fmt::format("{}:{}", performed.place.file, performed.place.begin.line);
    auto text = fmt::format("{} ({})", performed.event, place);
    if (std::find(refusal_.expected.begin(), refusal_.expected.end(), text) ==
        refusal_.expected.end()) {
      refusal_.expected.push_back(std::move(text));
    }
  }
  refusal_.plan_is_over = belief_->plan_may_be_over();
  return judged(admission, by_axioms);
}

}  // namespace parallax::tools
