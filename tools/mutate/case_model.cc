#include "tools/mutate/case_model.h"

#include <algorithm>
#include <map>
#include <set>

#include "tools/app/scenario_model.h"

namespace parallax::tools {
namespace {

bool is_scenario(const std::string& path) {
  return path.ends_with(".yaml") || path.ends_with(".yml");
}

CaseModel of_scenario(ScenarioModel loaded, const Context& context) {
  CaseModel out;
  out.compiled = std::move(loaded.compilation.model);
  out.plan = std::move(loaded.compilation.plan);
  for (const auto& model : loaded.scenario.models) out.models.emplace_back(model.text);
  out.load.named_by = {loaded.scenario.file};
  out.load.allow_outside = context.form().allow_outside;
  out.scenario = std::move(loaded.scenario);
  return out;
}

/// What is told with each event.
std::map<std::string, std::set<compiler::PlanArguments>> told(const compiler::PlanGraph& plan) {
  std::map<std::string, std::set<compiler::PlanArguments>> out;
  for (const auto& location : plan.locations) {
    out[location.event.text].insert(location.arguments);
  }
  return out;
}

}  // namespace

bool same_arguments(const compiler::PlanGraph& a, const compiler::PlanGraph& b) {
  const bool equal = std::equal(a.locations.begin(), a.locations.end(), b.locations.begin(),
                                b.locations.end(), [](const auto& x, const auto& y) {
                                  return x.event.text == y.event.text && x.arguments == y.arguments;
                                });
  if (equal) return true;
  const auto of_a = told(a), of_b = told(b);
  return std::all_of(of_a.begin(), of_a.end(), [&](const auto& event) {
    const auto other = of_b.find(event.first);
    return other == of_b.end() || (event.second.size() == 1 && event.second == other->second);
  });
}

base::Result<CaseModel> load_case_model(const SuiteCase& one, Context& context) {
  const auto* traces = std::get_if<harness::ManifestCase>(&one.check);
  if (traces == nullptr) {
    auto loaded = load_scenario_run(one.file, std::nullopt, context);
    if (!loaded) return context.sink().already_reported();
    return of_scenario(*std::move(loaded), context);
  }
  if (traces->models.size() == 1 && is_scenario(traces->models.front().text)) {
    auto loaded = load_scenario_model(traces->models.front().text, context);
    if (!loaded) return context.sink().already_reported();
    return of_scenario(*std::move(loaded), context);
  }
  ModelOptions options;
  for (const auto& model : traces->models) options.models.push_back(model.text);
  for (const auto& constraint : traces->constraints) options.until.push_back(constraint.text);
  if (traces->horizon) options.horizon = *traces->horizon;
  auto compiled = compile_models(options, context);
  if (!compiled) return context.sink().already_reported();
  CaseModel out;
  out.compiled = std::move(compiled->model);
  out.models.assign(options.models.begin(), options.models.end());
  out.load = compile_input(options, context).load;
  return out;
}

}  // namespace parallax::tools
