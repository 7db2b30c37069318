#include "tools/mutate/case_model.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>

#include "compiler/artifact/artifact_writer.h"
#include "compiler/base/sha256.h"
#include "tools/app/edited_scenario.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {
namespace {

bool is_scenario(const std::string& path) {
  return path.ends_with(".yaml") || path.ends_with(".yml");
}

/// The clauses and the meaning of their variables, without their origins.
std::string key_of_model(const compiler::CompiledModel& model) {
  constexpr std::string_view kComment = "c ";
  constexpr std::array<std::string_view, 8> kMeaning = {
      "c dec atom ",   "c dec fluent ", "c dec event ",       "c dec section ",
      "c dec stride ", "c dec base ",   "c dec state-slots ", "c dec horizon "};
  const auto text = compiler::to_artifact(model);
  std::string kept;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const auto line = std::string_view(text).substr(begin, end - begin);
    const bool counts = !line.starts_with(kComment) ||
                        std::any_of(kMeaning.begin(), kMeaning.end(),
                                    [&](auto prefix) { return line.starts_with(prefix); });
    if (counts) kept += line;
    begin = end;
  }
  return base::sha256_hex(kept);
}

CaseModel of_model(compiler::CompiledModel model) {
  CaseModel out;
  out.key = key_of_model(model);
  out.compiled = std::move(model);
  return out;
}

/// `as_run`: in the way that the scenario asks for; else for any trace of the plan.
base::Result<CaseModel> of_scenario(const std::string& path, bool as_run, Context& context) {
  auto& sink = context.sink();
  const bool allow_outside = context.form().allow_outside;
  auto scenario = harness::load_scenario(path, context.files(), sink, allow_outside);
  if (!scenario) return sink.already_reported();
  auto run = *scenario;
  if (!as_run) run.execution = harness::Execution::kOpenLoop;
  auto compiled = compile_edited(run, {}, context);
  if (!compiled) return sink.already_reported();
  auto out = of_model(std::move(compiled->model));
  out.plan = std::move(compiled->plan);
  for (const auto& model : scenario->models) out.models.emplace_back(model.text);
  out.load.named_by = {scenario->file};
  out.load.allow_outside = allow_outside;
  out.scenario = *std::move(scenario);
  return out;
}

/// The arguments that controllers get with each event.
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
  if (traces == nullptr) return of_scenario(one.file, true, context);
  if (traces->models.size() == 1 && is_scenario(traces->models.front().text)) {
    return of_scenario(traces->models.front().text, false, context);
  }
  ModelOptions options;
  for (const auto& model : traces->models) options.models.push_back(model.text);
  if (traces->horizon) options.horizon = *traces->horizon;
  auto compiled = compile_models(options, context);
  if (!compiled) return context.sink().already_reported();
  auto out = of_model(std::move(compiled->model));
  out.models.assign(options.models.begin(), options.models.end());
  out.load = compile_input(options, context).load;
  return out;
}

}  // namespace parallax::tools
