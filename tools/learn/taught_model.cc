#include "tools/learn/taught_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "compiler/base/codes/files.h"
#include "compiler/base/contract.h"
#include "compiler/base/ground_name.h"

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
  out->axioms_ = StateAxioms::make(out->declarations_, *out->vocabulary_, context, why);
  if (!out->axioms_) {
    return context.sink().error_about(codes::kUsage, scenario,
                                      "without its axioms about events the model is none: " + why);
  }
  out->relearn();
  if (out->text_.empty()) {
    return context.sink().error_about(codes::kUsage, scenario, "stopped");
  }
  return out;
}

void TaughtModel::leave_off(const std::string& id, std::size_t t) {
  left_off_.push_back(fmt::format("run {} at {}", id, t));
}

void TaughtModel::add(std::vector<ObservedPath> paths, const compiler::CompiledModel& model,
                      std::int64_t round, const std::set<std::string>& from_outcomes) {
  from_outcomes_.insert(from_outcomes.begin(), from_outcomes.end());
  for (auto& path : paths) {
    for (std::size_t t = 0; t < path.states.size(); ++t) {
      if (!path.in_no_state(t)) continue;
      in_no_state_.push_back(
          fmt::format("run {}/{}.{} at {}", round, path.id.trace, path.id.sample, t));
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
  for (const auto& step : run.steps) {
    if (run.executed && step.failed && says_not_possible(step.reason)) {
      attempted_.insert(base::symbol_of(step.event));
    }
  }
  const auto same = std::find_if(seen_.begin(), seen_.end(), [&](const auto& other) {
    return other.executed == run.executed && other.steps == run.steps && other.states == run.states;
  });
  if (same == seen_.end()) {
    seen_.push_back(std::move(run));
  } else {
    same->ids.insert(same->ids.end(), run.ids.begin(), run.ids.end());
  }
}

/// Decides which formulas about states hold, and up to where each run agrees with them.
void TaughtModel::settle_states(bool learns) {
  std::map<Evidence::State, std::size_t> places;
  std::vector<ReachedState> states;
  for (const auto& run : seen_) {
    for (const auto& state : run.states) {
      const auto [place, is_new] = places.emplace(state, states.size());
      if (is_new) states.push_back({state, {}, false});
      if (&state == &run.states.front()) states[place->second].start = true;
      auto& runs = states[place->second].runs;
      for (const auto& id : run.ids) {
        if (std::find(runs.begin(), runs.end(), id) == runs.end()) runs.push_back(id);
      }
    }
  }
  if (learns) axioms_->refute(states, context_.stop());
  if (version_ != axioms_->version()) {
    std::string why;
    auto compiled = compile_text(axioms_->text(true), 1, context_, why);
    PARALLAX_REQUIRE(compiled || context_.stopped(), "what says less is a model, too");
    if (!compiled) return;
    version_ = axioms_->version();
    completion_.reset();
    states_ = *std::move(compiled);
    completion_ = std::make_unique<StateCompletion>(*states_, *vocabulary_, context_.stop());
  }
  runs_.clear();
  left_off_ = in_no_state_;
  for (const auto& run : seen_) {
    auto& within = runs_.emplace_back(run);
    for (std::size_t t = 0; t < within.states.size(); ++t) {
      if (completion_->complete(within.states[t])) continue;
      leave_off(within.ids.front(), t);
      within.states.resize(t);
      within.steps.resize(t == 0 ? 0 : t - 1);
    }
    if (within.states.empty()) runs_.pop_back();
  }
}

void TaughtModel::relearn() {
  settle_states();
  if (context_.stopped()) return;  // what there is stays
  observations_ = std::make_unique<Observations>(*vocabulary_, *completion_);
  for (const auto& run : runs_) (void)observations_->add(run);
  auto effects = learn_effects(*observations_, attempted_, from_outcomes_, context_.stop());
  if (context_.stopped() && !text_.empty()) return;  // half of a model is worse than the last one
  effects_ = std::move(effects);
  text_ = learned_text(
      fmt::format("; Learned by `parallax learn` from the declarations of {} and from runs.\n"
                  "; Run 2/1.4 is sample 1.4 of the folder rounds/2/run.\n",
                  std::filesystem::path(scenario_).filename().string()),
      axioms_->text(false), effects_, *vocabulary_, declarations_.start);
}

bool TaughtModel::leaves_open() const {
  return axioms_->opens() ||
         std::any_of(effects_.rules.begin(), effects_.rules.end(),
                     [](const auto& rule) { return rule.kind == RuleKind::kReleases; });
}

std::vector<std::string> TaughtModel::axioms() const {
  std::vector<std::string> out;
  for (const auto& rule : effects_.rules) out.push_back(print(rule, *vocabulary_));
  return out;
}

std::vector<std::string> TaughtModel::all_axioms() const {
  auto out = axioms();
  out.push_back(axioms_->text(true));
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
  if (!left_off_.empty()) {
    out.push_back(
        fmt::format("{} runs from where they came to what no state of the model looks like, the "
                    "first of them {}",
                    left_off_.size(), left_off_.front()));
  }
  std::set<std::size_t> happened;
  for (const auto& step : observations_->transitions()) happened.insert(step.event);
  std::set<std::string> demanded;
  for (const auto& form : domain_->forms) {
    if (form.kind == compiler::AxiomForm::Kind::kTrigger) demanded.insert(form.event_symbol);
  }
  const auto& symbols = vocabulary_->symbols();
  for (std::size_t i = 0; i < symbols.size(); ++i) {
    const bool fluent = symbols[i].kind == compiler::SymbolKind::kFluent;
    if (fluent && symbols[i].inertial && !observations_->observed().contains(i)) {
      out.push_back(fmt::format("{}: the scenario does not observe it", symbols[i].name));
    }
    if (symbols[i].kind == compiler::SymbolKind::kEvent && !happened.contains(i)) {
      out.push_back(fmt::format("{}: {}", symbols[i].name,
                                demanded.contains(symbols[i].name)
                                    ? "the scenario's model demands it, and runs do not show when "
                                      "it happens"
                                    : "it never happened"));
    }
  }
  return out;
}

}  // namespace parallax::tools
