#include "tools/learn/taught_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "compiler/base/contract.h"
#include "compiler/base/diagnostic_codes.h"

namespace parallax::tools {

base::Result<std::unique_ptr<TaughtModel>> TaughtModel::make(const ScenarioModel& loaded,
                                                             const std::string& scenario,
                                                             Context& context) {
  auto out = std::unique_ptr<TaughtModel>(new TaughtModel(scenario, context));
  out->domain_ = load_domain(loaded.scenario, context);
  PARALLAX_REQUIRE(out->domain_ != nullptr, "the scenario was loaded with this model");
  out->declarations_ = declarations_of(*out->domain_);
  out->vocabulary_ = std::make_unique<LearnVocabulary>(*out->domain_->typed);
  std::string why;
  out->states_ = compile_text(out->declarations_.states, 1, context, why);
  if (!out->states_) {
    return context.sink().error_about(base::DiagnosticCode::kUsage, scenario,
                                      "without its axioms about events the model is none: " + why);
  }
  out->completion_ =
      std::make_unique<StateCompletion>(*out->states_, *out->vocabulary_, context.stop());
  out->relearn();
  return out;
}

void TaughtModel::leave_off(const std::string& id, std::size_t t) {
  ++left_off_;
  if (first_left_off_.empty()) first_left_off_ = fmt::format("run {} at {}", id, t);
}

void TaughtModel::add(std::vector<ObservedPath> paths, const compiler::CompiledModel& model,
                      std::int64_t round) {
  for (auto& path : paths) {
    for (std::size_t t = 0; t < path.states.size(); ++t) {
      if (!path.in_no_state(t)) continue;
      leave_off(fmt::format("{}/{}.{}", round, path.id.trace, path.id.sample), t);
      path.states.resize(t);
      path.points.resize(t);
      path.steps.resize(t == 0 ? 0 : t - 1);
    }
  }
  std::erase_if(paths, [](const auto& path) { return path.states.empty(); });
  for (auto& run : evidence_of(paths, model)) add(std::move(run), round);
}

void TaughtModel::add(Evidence run, std::int64_t round) {
  for (auto& id : run.ids) id = fmt::format("{}/{}", round, id);
  for (std::size_t t = 0; t < run.states.size(); ++t) {
    if (completion_->complete(run.states[t])) continue;
    leave_off(run.ids.front(), t);
    if (t == 0) return;
    run.states.resize(t);
    run.steps.resize(t - 1);
  }
  for (const auto& step : run.steps) {
    if (run.executed && step.failed && says_not_possible(step.reason)) {
      attempted_.insert(step.event.substr(0, step.event.find('(')));
    }
  }
  const auto same = std::find_if(runs_.begin(), runs_.end(), [&](const auto& other) {
    return other.executed == run.executed && other.steps == run.steps && other.states == run.states;
  });
  if (same == runs_.end()) {
    runs_.push_back(std::move(run));
  } else {
    same->ids.insert(same->ids.end(), run.ids.begin(), run.ids.end());
  }
}

void TaughtModel::relearn() {
  observations_ = std::make_unique<Observations>(*vocabulary_, *completion_);
  for (const auto& run : runs_) (void)observations_->add(run);
  auto effects = learn_effects(*observations_, attempted_, context_.stop());
  if (context_.stopped() && !text_.empty()) return;  // half of a model is worse than the last one
  effects_ = std::move(effects);
  text_ = learned_text(
      declarations_, effects_, *vocabulary_,
      fmt::format("; Learned by `parallax learn` from the declarations of {} and from runs.\n"
                  "; Run 2/1.4 is sample 1.4 of the folder rounds/2/run.\n",
                  std::filesystem::path(scenario_).filename().string()));
}

std::vector<std::string> TaughtModel::axioms() const {
  std::vector<std::string> out;
  for (const auto& rule : effects_.rules) out.push_back(print(rule, *vocabulary_));
  return out;
}

RunsCheck TaughtModel::check(const std::vector<Evidence>& runs) const {
  return check_runs(text_, runs, effects_.rules, *vocabulary_, context_);
}

std::vector<std::string> TaughtModel::not_learned() const {
  std::vector<std::string> out;
  for (const auto& symbol : vocabulary_->left_out()) {
    out.push_back(
        fmt::format("{}: it has more than {} ground atoms", symbol, LearnVocabulary::kMostAtoms));
  }
  for (const auto& what : effects_.unexplained) {
    out.push_back(what + ": none of the rules that are looked for");
  }
  if (left_off_ > 0) {
    out.push_back(
        fmt::format("{} runs from where they came to what no state of the model looks like, the "
                    "first of them {}",
                    left_off_, first_left_off_));
  }
  std::set<std::size_t> happened;
  for (const auto& step : observations_->transitions()) happened.insert(step.event);
  const auto& symbols = vocabulary_->symbols();
  for (std::size_t i = 0; i < symbols.size(); ++i) {
    const bool fluent = symbols[i].kind == compiler::SymbolKind::kFluent;
    if (fluent && symbols[i].inertial && !observations_->observed().contains(i)) {
      out.push_back(fmt::format("{}: the scenario does not observe it", symbols[i].name));
    }
    if (symbols[i].kind == compiler::SymbolKind::kEvent && !happened.contains(i)) {
      out.push_back(fmt::format("{}: it never happened", symbols[i].name));
    }
  }
  return out;
}

}  // namespace parallax::tools
