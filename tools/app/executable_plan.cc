#include "tools/app/executable_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/plan/plan_walk.h"

namespace parallax::tools {

using compiler::LocationId;
using compiler::RegisterObjects;

namespace {

harness::State state_of(const compiler::PlanArguments& arguments) {
  harness::State out;
  for (const auto& [name, value] : arguments) {
    if (const auto* number = std::get_if<double>(&value)) out[name] = *number;
    if (const auto* integer = std::get_if<std::int64_t>(&value)) out[name] = *integer;
    if (const auto* text = std::get_if<std::string>(&value)) out[name] = *text;
  }
  return out;
}

std::set<compiler::ModelValueId> registers_of(const compiler::PlanLocation& location) {
  auto out = registers_in(location.event);
  for (const auto& [name, value] : location.arguments) {
    if (const auto* id = std::get_if<compiler::ModelValueId>(&value)) out.insert(*id);
  }
  return out;
}

}  // namespace

class ScenarioPlanExecution final : public harness::PlanExecution,
                                    private compiler::PlanSurroundings {
 public:
  ScenarioPlanExecution(const ScenarioPlan& plan, const harness::DrawKey& key)
      : plan_(plan), choices_(key), walk_(plan.graph_) {}

  std::optional<harness::PlannedPerform> next(const harness::State& observed) override {
    observed_ = &observed;
    walk_.go_on(*this);
    const auto id = walk_.location();
    if (!id) return std::nullopt;
    return plan_.perform(*id, walk_.registers());
  }

  std::optional<harness::PathEnd> tell(const harness::ActionOutcome& outcome,
                                       const harness::State& before, const harness::State& after,
                                       harness::PathStep& step) override {
    const auto id = *walk_.location();
    const auto& location = plan_.graph_.locations[id];
    const auto& state = location.success.time_offset == 0 ? before : after;
    if (outcome.status == harness::SimStatus::kOk && (!plan_.formula_decides_ || good(id, state))) {
      if (location.result) {
        step.object = outcome.object.empty() ? found(id, state) : outcome.object;
        if (step.object.empty()) return harness::PathEnd::kUnnamedObject;
      }
      step.succeeded = true;
      walk_.succeed(step.object);
      return std::nullopt;
    }
    const auto condition = walk_.fail(reason_word(outcome));
    if (!condition) return harness::PathEnd::kUnboundReason;
    step.condition = *condition;
    return std::nullopt;
  }

  harness::PathEnd end(std::string& detail) const override {
    const auto& terminal = *walk_.end();
    detail = terminal.detail;
    if (terminal.kind == compiler::TerminalKind::kFailed) return harness::PathEnd::kFailed;
    const bool cut = terminal.kind == compiler::TerminalKind::kBound;
    return cut ? harness::PathEnd::kCut : harness::PathEnd::kDone;
  }

  const std::vector<compiler::PlanDecision>& passed() const { return walk_.passed(); }

 private:
  bool holds(compiler::BranchId branch, const RegisterObjects& registers) override {
    return plan_.questions_.holds(branch, registers,
                                  [&](std::uint32_t fluent) { return reads(fluent, *observed_); });
  }

  std::uint64_t choose(std::uint64_t count) override { return choices_.bits(drawn_++) % count; }

  bool reads(std::uint32_t fluent, const harness::State& state) const {
    return plan_.mapping_.holds(plan_.fluents_[fluent], state).value_or(false);
  }

  bool good(LocationId id, const harness::State& state) const {
    return plan_.questions_.succeeds(id, walk_.registers(),
                                     [&](std::uint32_t fluent) { return reads(fluent, state); });
  }

  /// Any one of what the formula of success holds for.
  std::string found(LocationId id, const harness::State& state) {
    if (!plan_.unseen(id).empty()) return {};
    const auto objects = plan_.questions_.found(
        id, walk_.registers(), [&](std::uint32_t fluent) { return reads(fluent, state); });
    if (objects.empty()) return {};
    return objects[objects.size() == 1 ? 0 : choose(objects.size())];
  }

  const ScenarioPlan& plan_;
  harness::CounterRng choices_;
  std::uint64_t drawn_ = 0;
  compiler::PlanWalk walk_;
  const harness::State* observed_ = nullptr;
};

ScenarioPlan::ScenarioPlan(const ScenarioModel& loaded, const Context& context)
    : loaded_(loaded),
      graph_(*loaded.compilation.plan),
      mapping_(*loaded.scenario.mapping),
      formula_decides_(!loaded.scenario.simulator.models.empty()),
      questions_(graph_, *loaded.compilation.plan_formulas, *loaded.compilation.typed) {
  for (const auto& name : questions_.fluents()) fluents_.push_back(harness::ground_fluent(name));
  for (const auto& location : graph_.locations) {
    places_.push_back(context.files().place(location.source));
  }
}

std::string ScenarioPlan::unseen(const compiler::PlanQuestions::Needs& needs) const {
  if (!needs.one_state) return "it is not about the fluents of one timepoint";
  for (const auto number : needs.fluents) {
    const auto* binding = mapping_.find(fluents_[number].symbol);
    if (binding == nullptr || binding->is_ignored() || binding->at_start_only()) {
      return fmt::format("`{}` is not observed", fluents_[number].text);
    }
  }
  return {};
}

std::string ScenarioPlan::unseen(LocationId location) const {
  return unseen(questions_.of_success(location));
}

base::Status ScenarioPlan::settle(const std::function<base::Known(const std::string&)>& value,
                                  base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  if (questions_.too_large()) {
    return sink.error(codes::kQuestionNotObserved, loaded_.scenario.execution_source,
                      "the plan's formulas have too many instances");
  }
  for (std::size_t i = 0; i < questions_.predicates().size(); ++i) {
    questions_.settle(i, value(questions_.predicates()[i]) == base::Known::kYes);
  }
  for (std::size_t i = 0; i < graph_.branches.size(); ++i) {
    const auto id = graph_.branches.id_at(i);
    const auto& branch = graph_.branches[id];
    if (branch.free) continue;
    const auto why = unseen(questions_.of_guard(id));
    if (why.empty()) continue;
    sink.error(codes::kQuestionNotObserved, branch.source,
               fmt::format("{}; asked is `{}`", why, branch.text()));
  }
  for (std::size_t i = 0; i < graph_.locations.size() && formula_decides_; ++i) {
    const auto id = graph_.locations.id_at(i);
    const auto why = unseen(id);
    if (why.empty()) continue;
    const auto& success = graph_.locations[id].success;
    sink.error(codes::kQuestionNotObserved, success.source,
               fmt::format("{}; asked is `{}`", why, success.formula.text));
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return base::Unit{};
}

std::unique_ptr<harness::PlanExecution> ScenarioPlan::begin(const harness::DrawKey& key) const {
  return std::make_unique<ScenarioPlanExecution>(*this, key);
}

std::optional<PlanPath> ScenarioPlan::retrace(const harness::DrawKey& key,
                                              const harness::SampleRecord& record) const {
  const auto& steps = record.path->steps;
  const auto& seen = record.observations;
  if (seen.size() != steps.size() + 1 || record.outcomes.size() != steps.size()) {
    return std::nullopt;
  }
  ScenarioPlanExecution execution(*this, key);
  PlanPath path;
  for (std::size_t i = 0;; ++i) {
    const auto perform = execution.next(seen[i]);
    path.decisions.insert(path.decisions.end(), execution.passed().begin(),
                          execution.passed().end());
    // A limit may have ended it where the plan goes on.
    if (i == steps.size()) return path;
    if (!perform || perform->step != steps[i].step || perform->event != steps[i].event) {
      return std::nullopt;
    }
    harness::PathStep told;
    if (execution.tell(record.outcomes[i], seen[i], seen[i + 1], told)) return std::nullopt;
    if (told.succeeded != steps[i].succeeded || told.object != steps[i].object ||
        told.condition != steps[i].condition) {
      return std::nullopt;
    }
    PlanPath::Step step{LocationId(static_cast<std::uint32_t>(perform->step)), told.succeeded};
    const auto& ways = graph_.locations[step.location].failures;
    for (std::size_t way = 0; way < ways.size() && !told.succeeded; ++way) {
      if (ways[way].failure_class == told.condition) step.way = way;
    }
    path.steps.push_back(step);
  }
}

harness::PlannedPerform ScenarioPlan::perform(LocationId id,
                                              const RegisterObjects& registers) const {
  const auto& location = graph_.locations[id];
  return {static_cast<std::int64_t>(id.index()), event_text(location, registers),
          places_[id.index()], state_of(arguments_of(location, registers))};
}

std::vector<harness::PlannedPerform> ScenarioPlan::performs() const {
  constexpr std::size_t kMaxOfOne = 1'000;  // of one location; a controller refuses what is left
  const auto& typed = *loaded_.compilation.typed;
  const auto& sorts = loaded_.compilation.plan_formulas->register_sorts;
  std::vector<harness::PlannedPerform> out;
  for (std::size_t i = 0; i < graph_.locations.size(); ++i) {
    const auto id = graph_.locations.id_at(i);
    std::vector<RegisterObjects> readings = {{}};
    for (const auto value : registers_of(graph_.locations[id])) {
      std::vector<RegisterObjects> more;
      for (const auto& object : typed.objects) {
        const auto fits = [&](compiler::SortId sort) {
          return typed.is_subsort(sort, sorts[value.index()]);
        };
        if (!std::any_of(object.sorts.begin(), object.sorts.end(), fits)) continue;
        for (const auto& reading : readings) {
          if (more.size() == kMaxOfOne) break;
          more.push_back(reading);
          more.back()[value] = object.name;
        }
      }
      readings = std::move(more);
    }
    for (const auto& reading : readings) out.push_back(perform(id, reading));
  }
  return out;
}

}  // namespace parallax::tools
