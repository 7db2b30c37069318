#include "tools/repair/plan_step.h"

#include <algorithm>
#include <utility>

#include "compiler/base/file_io.h"
#include "compiler/base/ground_name.h"
#include "compiler/repair/edit_grammar.h"
#include "tools/repair/patch.h"

namespace parallax::tools {

namespace {

constexpr std::size_t kMostSites = 16;      // that actions are inserted at
constexpr std::size_t kMostConditions = 6;  // that a guard may ask for
constexpr std::int64_t kMoreSteps = 3;      // than the scenario has, for what an edit adds

void add_once(std::vector<compiler::DatumId>& list, compiler::DatumId form) {
  if (std::find(list.begin(), list.end(), form) == list.end()) list.push_back(form);
}

/// Texts are read anew for every compilation; names and places stay.
base::SourceRange in_own_text(const base::SourceRange& source, const compiler::PlanText& plan,
                              const base::SourceFiles& files) {
  const auto& name = files[source.file].name();
  for (std::uint32_t i = 0; i < plan.data().end_id().index(); ++i) {
    const auto& own = plan.source(compiler::DatumId(i));
    if (files[own.file].name() == name) return {own.file, source.begin, source.end};
  }
  return source;
}

/// Finds values of fluents before the failing step that they never had where the event went well.
void find_difference(const RepairInput& input, PlanStep& step) {
  const auto& failing = step.task.evidence->states[step.task.step];
  auto out = failing;
  bool any = false;
  for (const auto& seen : input.evidence) {
    for (std::size_t t = 0; t < seen.steps.size() && t < seen.seen_to(); ++t) {
      const bool parted = seen.divergence == t + 1;
      const bool same_event = seen.steps[t].event == step.task.bad.step.event;
      if (!same_event || seen.steps[t].failed || parted) continue;
      step.went_well = true;
      if (seen.states[t] == failing) continue;
      any = true;
      std::erase_if(out, [&](const auto& entry) {
        const auto other = seen.states[t].find(entry.first);
        return other == seen.states[t].end() || other->second == entry.second;
      });
    }
  }
  if (any) step.differing = std::move(out);
}

/// The forms of the text at which the plan was, the last one first.
void find_forms(const std::vector<compiler::LocationId>& path, const compiler::PlanGraph& graph,
                const compiler::PlanText& plan, const base::SourceFiles& files, PlanScope& scope) {
  for (auto k = path.size(); k-- > 0;) {
    const auto& location = graph.locations[path[k]];
    auto forms = location.calls;
    forms.push_back(location.source);
    for (const auto& source : forms) {
      const auto form = plan.form_at(in_own_text(source, plan, files));
      if (!form) continue;
      if (k + 1 == path.size()) add_once(scope.failing, *form);
      const auto statement = plan.statement_around(*form);
      if (statement && scope.sites.size() < kMostSites) add_once(scope.sites, *statement);
    }
  }
  // The perform itself first, then the calls that lead to it.
  std::reverse(scope.failing.begin(), scope.failing.end());
}

std::string failure_at(const compiler::PlanLocation& location, const std::string& reason) {
  auto out = location.failure_class;
  for (const auto& way : location.failures) {
    const bool fits =
        std::find(way.reasons.begin(), way.reasons.end(), reason) != way.reasons.end();
    if (fits) out = way.failure_class;
  }
  return out;
}

}  // namespace

std::optional<PlanSource> read_plan(const RepairInput& input, Context& context) {
  const auto& scenario = input.loaded.scenario;
  if (scenario.plan.empty() || !scenario.bind || !input.loaded.compilation.plan) {
    return std::nullopt;
  }
  const auto before = context.sink();
  const auto files = load_scenario_plan(scenario, context);
  const auto bind = base::load_text(scenario.bind->text, context.files(), context.sink());
  std::optional<compiler::PlanText> text;
  if (files) text = compiler::PlanText::read(context.files(), *files);
  std::optional<PlanSource> out;
  if (text && bind) {
    auto binding = compiler::parse_plan_binding(context.files(), *bind, context.sink());
    if (binding) out = PlanSource{*std::move(text), *std::move(binding)};
  }
  context.sink() = before;
  return out;
}

std::optional<PlanStep> find_plan_step(const RepairInput& input, const PlanSource& source,
                                       const RunParting& parting, Context& context,
                                       std::vector<std::string>& remarks) {
  const auto seen =
      std::find_if(input.evidence.begin(), input.evidence.end(),
                   [&](const Evidence& each) { return each.ids.front() == parting.ids.front(); });
  if (seen == input.evidence.end()) return std::nullopt;
  PlanStep out;
  auto& task = out.task;
  task.scenario = &input.loaded.scenario;
  task.plan = &source.text;
  task.evidence = &*seen;
  task.step = parting.after - 1;
  task.bad = {parting.step, parting.seen};
  task.horizon = input.loaded.compilation.model.horizon + kMoreSteps;
  find_difference(input, out);

  const bool constrained = has_constraints(*task.scenario);
  PlanModel::Wrong wrong;
  const auto model = compile_plan(task, input.text, {}, constrained, context, wrong);
  if (!model) {
    remarks.push_back("the plan by itself cannot be compiled: " + wrong.why);
    return std::nullopt;
  }
  const auto start = model->start(*task.evidence);
  const auto path = model->locations(*task.evidence, task.step);
  if (!start || path.empty()) return std::nullopt;
  PlanGoal constraints, done;
  constraints.constraints = done.done = true;
  if (constrained) task.goal.constraints = model->reaches(constraints, *start) == true;
  task.goal.done = model->reaches(done, *start) == true;
  if (!task.goal.any()) return std::nullopt;

  auto& scope = out.scope;
  scope.plan = &source.text;
  scope.binding = &source.binding;
  scope.typed = &*input.domain->typed;
  find_forms(path, model->graph(), source.text, context.files(), scope);
  scope.failure = failure_at(model->graph().locations[path.back()], task.bad.step.reason);
  for (const auto& [fluent, holds] : out.differing) {
    if (is_defined(input, fluent) || scope.conditions.size() == kMostConditions) continue;
    scope.conditions.push_back(compiler::plan_condition(fluent, !holds));
  }
  return out;
}

std::unique_ptr<PlanModel> compile_plan(const PlanTask& task, const std::string& model,
                                        const std::vector<compiler::TextChange>& changes,
                                        bool constraints, Context& context,
                                        PlanModel::Wrong& wrong) {
  EditedTexts texts;
  texts.model = model;
  for (const auto& file : changed_files(task.plan->files(), changes)) {
    texts.plan.emplace(file.name, file.after);
  }
  texts.horizon = task.horizon;
  texts.constraints = constraints;
  return PlanModel::compile(*task.scenario, texts, context, wrong);
}

bool has_constraints(const harness::Scenario& scenario) {
  return !scenario.constraints.empty() && scenario.execution != harness::Execution::kClosedLoop;
}

bool is_defined(const RepairInput& input, const std::string& fluent) {
  const auto& typed = *input.domain->typed;
  const auto symbol = typed.find_symbol(base::symbol_of(fluent));
  return symbol && typed.symbols[*symbol].noninertial;
}

}  // namespace parallax::tools
