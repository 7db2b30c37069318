#include "tools/app/closed_loop.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <string>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/contract.h"
#include "compiler/base/suggest.h"
#include "harness/campaign/trial.h"
#include "tools/app/cover_items.h"
#include "tools/app/plan_reservations.h"
#include "tools/app/start_guide.h"
#include "tools/app/start_weights.h"
#include "tools/app/trace_feed.h"

namespace parallax::tools {

namespace {

constexpr std::size_t kMaxInitialStates = 10'000;

}  // namespace

ClosedLoop::ClosedLoop(const ScenarioModel& loaded, Context& context)
    : loaded_(loaded),
      context_(context),
      symbols_(runtime::symbols_of(loaded.compilation.model)),
      session_(loaded.compilation.model, runtime::make_cadical_solver(&context.stop())),
      admission_(session_),
      plan_(std::make_unique<ScenarioPlan>(loaded, context)) {}

base::Result<std::unique_ptr<ClosedLoop>> ClosedLoop::make(const ScenarioModel& loaded,
                                                           Context& context) {
  if (const auto& plan = loaded.compilation.plan; plan && !plan->inputs.empty()) {
    return context.sink().error_about(
        codes::kUsage, "--plan-entry",
        fmt::format("an executed plan needs a value for `{}`", plan->values[plan->inputs[0]].name));
  }
  auto out = std::unique_ptr<ClosedLoop>(new ClosedLoop(loaded, context));
  const auto value = [&](const std::string& predicate) {
    return runtime::predicate_value(out->session_, predicate);
  };
  if (!out->plan_->settle(value, context.sink())) return context.sink().already_reported();
  return out;
}

std::int64_t ClosedLoop::max_performs() const { return loaded_.compilation.model.horizon; }

/// An execution that comes to a cut is known to be unfinished; it takes no words in advance.
std::vector<std::string> ClosedLoop::bounds() const {
  return gap_texts(loaded_.compilation.plan, context_);
}

std::string ClosedLoop::reservation() const {
  return reservations_of(loaded_.compilation.plan).words();
}

base::Result<std::optional<harness::LoopStates>> ClosedLoop::initial_states(
    std::span<const compiler::FluentId> fluents) {
  auto& sink = context_.sink();
  const auto& model = loaded_.compilation.model;
  auto found = runtime::initial_states(model, runtime::make_cadical_solver(&context_.stop()),
                                       fluents, kMaxInitialStates);
  if (found.stopped) return std::optional<harness::LoopStates>();
  if (found.more) {
    return sink.error(codes::kTooManyInitialStates,
                      base::SourceRange{loaded_.scenario.source, 0, 0}, kMaxInitialStates);
  }
  if (found.states.empty()) {
    (void)report_if_unsatisfiable(model, 0, context_);
    return sink.already_reported();
  }
  compared_.assign(fluents.begin(), fluents.end());
  harness::LoopStates out;
  if (loaded_.scenario.start_weights.empty()) {
    out.holds = std::move(found.states);
  } else {
    const auto value = [&](const std::string& predicate) {
      return runtime::predicate_value(session_, predicate);
    };
    const auto weights = start_weights(loaded_, found.states, compared_, value, context_);
    if (!weights) return sink.already_reported();
    if (weights->are_all_zero()) return report_no_weight(loaded_, found.states.size(), context_);
    note_idle_weights(loaded_, weights->held, context_);
    for (std::size_t i = 0; i < found.states.size(); ++i) {
      if (weights->weights[i] == 0.0) continue;
      out.holds.push_back(std::move(found.states[i]));
      out.weights.push_back(weights->weights[i]);
    }
  }
  leave_out_states_without_start(out);
  states_ = out.holds;
  return std::optional(std::move(out));
}

void ClosedLoop::leave_out_states_without_start(harness::LoopStates& states) const {
  const harness::ModelFluents fluents(*symbols_);
  harness::LoopStates kept;
  for (std::size_t i = 0; i < states.holds.size(); ++i) {
    std::set<std::string> names;
    for (const auto fluent : states.holds[i]) names.insert(symbols_->name(fluent));
    auto why = harness::why_no_start(loaded_.scenario, fluents.ground(), names);
    if (why) {
      kept.without_start.push_back({states.holds[i], *std::move(why)});
      continue;
    }
    kept.holds.push_back(states.holds[i]);
    if (!states.weights.empty()) kept.weights.push_back(states.weights[i]);
  }
  if (kept.holds.empty()) return;  // what is wrong with the first is reported when it is prepared
  states = std::move(kept);
}

harness::StartGuide* ClosedLoop::guide(std::uint64_t seed) {
  if (loaded_.scenario.starts != harness::Starts::kGuided) return nullptr;
  const auto& coverage = plan_coverage();
  guide_ = std::make_unique<ScenarioStartGuide>(
      start_candidates(loaded_, *this, coverage, states_, compared_), coverage, *plan_, seed);
  return guide_.get();
}

harness::CoverWatch* ClosedLoop::cover(std::uint64_t seed) {
  cover_ = ScenarioCoverWatch::make(loaded_, *this, plan_coverage(), seed, context_.files());
  return cover_.get();
}

const PlanCoverage& ClosedLoop::plan_coverage() {
  if (!plan_coverage_) {
    plan_coverage_ = std::make_unique<PlanCoverage>(*loaded_.compilation.plan,
                                                    *loaded_.compilation.typed, context_.files());
  }
  return *plan_coverage_;
}

base::Known ClosedLoop::admits(std::span<const harness::PathStep> performs, std::size_t outcomes,
                               std::span<const ObservedFluents> observed) {
  std::vector<runtime::ExecutedPerform> executed;
  for (const auto& step : performs) {
    executed.push_back({compiler::PlanStepId(static_cast<std::uint32_t>(step.step)), step.event,
                        step.succeeded, step.object});
  }
  return admission_.admits(executed, outcomes, observed);
}

std::optional<runtime::Trace> ClosedLoop::trace_of(std::span<const harness::PathStep> performs,
                                                   std::size_t outcomes,
                                                   std::span<const ObservedFluents> observed) {
  if (admits(performs, outcomes, observed) != base::Known::kYes) return std::nullopt;
  const auto length = static_cast<compiler::Timepoint>(performs.size());
  return runtime::decode_trace(loaded_.compilation.model, symbols_, length,
                               [&](compiler::Literal literal) { return session_.value(literal); });
}

base::DiagnosticBuilder ClosedLoop::report_end(const harness::ExecutedPath& path,
                                               const std::string& reason) {
  auto& sink = context_.sink();
  const auto& graph = *loaded_.compilation.plan;
  const auto& step = path.steps.back();
  const compiler::LocationId id(static_cast<std::uint32_t>(step.step));
  const auto& location = graph.locations[id];
  if (path.end == harness::PathEnd::kUnnamedObject) {
    auto why = plan_->unseen(id);
    if (why.empty()) why = "it holds of nothing";
    auto error = sink.error(codes::kUnnamedObject, location.binding, step.event, why);
    error.note(location.source, "performed here");
    return error;
  }
  auto error = sink.error(codes::kUnboundReason, location.binding, step.event, reason);
  error.note(location.source, "performed here");
  std::vector<std::string> known;
  for (const auto& [failure_class, reasons] : location.failures) {
    for (const auto& bound : reasons) known.push_back(bound);
  }
  if (const auto near = base::nearest_name(reason, known, 4)) {
    error.note(fmt::format("the nearest reason that is bound: `{}`", *near));
  }
  error.note(fmt::format("bound here: {}", fmt::join(known, ", ")));
  return error;
}

}  // namespace parallax::tools
