#include "tools/app/start_weights.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/scenarios.h"
#include "compiler/pipeline/plan_questions.h"
#include "compiler/pipeline/state_constraint.h"

namespace parallax::tools {

namespace {

/// The formulas as guards of a plan that has nothing else, to be evaluated in one state.
struct WeightQuestions {
  compiler::PlanGraph graph;
  std::vector<compiler::BranchId> guards;  // by formula
  std::optional<compiler::PlanQuestions> questions;
};

base::Result<std::vector<compiler::StateConstraint>> check(const harness::Scenario& scenario,
                                                           compiler::TypedModel& model,
                                                           Context& context) {
  std::vector<compiler::ConstraintText> texts;
  for (const auto& entry : scenario.start_weights) {
    texts.push_back(constraint_text(entry.when, context.files()));
  }
  return compiler::check_constraints(texts, compiler::Constraints::kStates, model, context.files(),
                                     context.sink());
}

base::Result<WeightQuestions> questions_of(const ScenarioModel& loaded, Context& context) {
  auto model = *loaded.compilation.typed;
  const auto checked = check(loaded.scenario, model, context);
  if (!checked) return context.sink().already_reported();
  WeightQuestions out;
  compiler::PlanFormulas formulas;
  for (const auto& formula : *checked) {
    compiler::PlanBranch branch;
    branch.source = formula.source;
    out.guards.push_back(out.graph.branches.add(std::move(branch)));
    formulas.guards.push_back({formula.formula, {}, {}});
  }
  out.questions.emplace(out.graph, formulas, model);
  return out;
}

}  // namespace

base::Status check_start_weights(const harness::Scenario& scenario,
                                 const compiler::TypedModel& model, Context& context) {
  auto copy = model;
  if (!check(scenario, copy, context)) return context.sink().already_reported();
  return base::Unit{};
}

base::Result<StateWeights> start_weights(
    const ScenarioModel& loaded, const std::vector<std::vector<compiler::FluentId>>& states,
    const std::vector<compiler::FluentId>& fluents,
    const std::function<base::Known(const std::string&)>& predicate, Context& context) {
  auto& sink = context.sink();
  const auto errors_before = sink.error_count();
  auto asked = questions_of(loaded, context);
  if (!asked) return sink.already_reported();
  auto& questions = *asked->questions;
  const auto& entries = loaded.scenario.start_weights;
  if (questions.too_large()) {
    return sink.error(codes::kQuestionNotObserved, loaded.scenario.start_weights_source,
                      "the formulas of `start_weights` have too many instances");
  }
  for (std::size_t i = 0; i < questions.predicates().size(); ++i) {
    questions.settle(i, predicate(questions.predicates()[i]) == base::Known::kYes);
  }
  // A fluent that the model has not never holds.
  std::vector<std::optional<compiler::FluentId>> ids;
  std::map<std::string, compiler::FluentId> known;
  const auto& model = loaded.compilation.model;
  for (std::uint32_t i = 0; i < model.fluents.size(); ++i) {
    known.emplace(model.fluents[i].name, compiler::FluentId(i));
  }
  for (const auto& name : questions.fluents()) {
    const auto found = known.find(name);
    ids.push_back(found == known.end() ? std::nullopt : std::optional(found->second));
  }
  const auto is_compared = [&](compiler::FluentId id) {
    return std::find(fluents.begin(), fluents.end(), id) != fluents.end();
  };
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto& needs = questions.of_guard(asked->guards[i]);
    std::string why;
    if (!needs.one_state) why = "it is not about the fluents of timepoint 0";
    for (const auto number : needs.fluents) {
      if (why.empty() && ids[number] && !is_compared(*ids[number])) {
        why = fmt::format("`{}` is not compared", questions.fluents()[number]);
      }
    }
    if (why.empty()) continue;
    sink.error(codes::kQuestionNotObserved, entries[i].when.source,
               fmt::format("{}; asked is `{}`", why, entries[i].when.text));
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  StateWeights out;
  for (const auto& state : states) {
    const auto holds = [&](std::uint32_t number) {
      return ids[number] && std::binary_search(state.begin(), state.end(), *ids[number]);
    };
    std::optional<double> weight;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (!questions.holds(asked->guards[i], {}, holds)) continue;
      out.held.insert(i);
      if (!weight) weight = entries[i].weight;
    }
    out.weights.push_back(weight.value_or(1.0));
  }
  return out;
}

bool StateWeights::are_all_zero() const {
  return std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0.0; });
}

base::Reported report_no_weight(const ScenarioModel& loaded, std::size_t states, Context& context) {
  return context.sink().error(
      codes::kYamlOutOfBounds, loaded.scenario.start_weights_source, "the weight of initial states",
      fmt::format("0 for each of the {} that the model has", states), "above 0 for one of them");
}

void note_idle_weights(const ScenarioModel& loaded, const std::set<std::size_t>& held,
                       Context& context) {
  const auto& entries = loaded.scenario.start_weights;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (held.contains(i)) continue;
    context.remark(fmt::format("`start_weights`: no initial state has what is asked for by `{}`",
                               entries[i].when.text));
  }
}

}  // namespace parallax::tools
