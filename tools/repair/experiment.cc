#include "tools/repair/experiment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <tuple>

#include "harness/region/state_mapping.h"
#include "runtime/compare/trace_difference.h"
#include "runtime/trace/trace.h"
#include "tools/app/trace_feed.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kMostRefinements = 100;  // of a DifferenceFinder
constexpr int kMostTries = 12;                 // traces of one pair that cannot be used

}  // namespace

std::string start_key(const harness::CampaignTrace& trace) {
  return fmt::format("{}", fmt::join(trace.holds(0), ";"));
}
std::string experiment_key(const harness::CampaignTrace& trace) {
  return runtime::event_key(trace) + " from " + start_key(trace);
}

/// A model with the scenario's plan; without a compilation, no run can be of that model.
struct ExperimentChooser::Model {
  std::optional<compiler::Compilation> compilation;
  std::optional<runtime::ComparedModel> compared;
  std::unique_ptr<runtime::SolverSession> session;
};

ExperimentChooser::ExperimentChooser(const ScenarioModel& loaded, Context& context)
    : loaded_(loaded), context_(context) {
  for (const auto& fluent : loaded.compilation.model.fluents) {
    const auto* binding = loaded.scenario.mapping->find(harness::ground_fluent(fluent.name).symbol);
    if (binding != nullptr && !binding->is_ignored()) observed_.insert(fluent.name);
  }
}

ExperimentChooser::~ExperimentChooser() = default;

std::size_t ExperimentChooser::number_of(const std::string& text) {
  const auto [known, fresh] = numbers_.emplace(text, models_.size());
  if (!fresh) return known->second;
  auto model = std::make_unique<Model>();
  const auto before = context_.sink();  // what is said of an edited model is not reported
  auto compiled =
      compile_with_model(loaded_.scenario, text, loaded_.scenario.execution, false, context_);
  context_.sink() = before;
  if (compiled) {
    model->compilation = *std::move(compiled);
    model->compared.emplace(model->compilation->model);
    model->session = std::make_unique<runtime::SolverSession>(
        model->compilation->model, runtime::make_cadical_solver(&context_.stop()));
  }
  models_.push_back(std::move(model));
  return known->second;
}

bool ExperimentChooser::are_same(const std::string& first, const std::string& second) const {
  const auto a = numbers_.find(first), b = numbers_.find(second);
  if (a == numbers_.end() || b == numbers_.end()) return false;
  return same_as(a->second) == same_as(b->second);
}

std::size_t ExperimentChooser::same_as(std::size_t model) const {
  const auto found = same_.find(model);
  return found == same_.end() ? model : found->second;
}

/// Has the model, with the plan, an execution that goes like the trace as far as it is observed?
bool ExperimentChooser::admits(Model& model, const harness::CampaignTrace& trace) const {
  const auto& compiled = model.compilation->model;
  std::vector<runtime::Literal> facts;
  const auto add = [&](const std::vector<compiler::GroundName>& names, const runtime::Names& is,
                       std::size_t t, bool all) {
    std::size_t known = 0;
    for (const auto& name : names) {
      const bool holds = std::binary_search(is.begin(), is.end(), name.name);
      if (!all && !observed_.contains(name.name)) continue;
      if (!name.slot) {
        if (holds) return false;
        continue;
      }
      known += holds ? 1 : 0;
      const auto literal = runtime::Literal::positive(
          compiled.variable(*name.slot, static_cast<compiler::Timepoint>(t)));
      facts.push_back(holds ? literal : ~literal);
    }
    return !all || known == is.size();
  };
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    if (!add(compiled.fluents, trace.holds(t), t, false)) return false;
    if (t + 1 < trace.points.size() && !add(compiled.events, trace.happens(t), t, true)) {
      return false;
    }
  }
  return model.session->solve(trace.length(), facts) != runtime::SolveStatus::kUnsatisfiable;
}

void ExperimentChooser::find(Pair pair,
                             const std::function<bool(const harness::CampaignTrace&)>& usable,
                             std::map<std::string, harness::CampaignTrace>& found) {
  auto& first = *models_[pair.first]->compared;
  auto& second = *models_[pair.second]->compared;
  const auto horizon = std::min(first.model().horizon, second.model().horizon);
  const auto& a = first.up_to(horizon);
  const auto& b = second.up_to(horizon);
  auto vocabulary = runtime::shared_vocabulary(a, b, horizon);
  std::erase_if(vocabulary.shared, [&](const runtime::SharedAtom& atom) {
    return atom.kind == compiler::AtomKind::kHoldsAt &&
           !observed_.contains(vocabulary.names[atom.name]);
  });
  const auto* stop = &context_.stop();
  const auto of_first = first.definitions(vocabulary, &runtime::SharedAtom::first, horizon, stop);
  const auto of_second =
      second.definitions(vocabulary, &runtime::SharedAtom::second, horizon, stop);
  runtime::DifferenceFinder finder(a, of_first, b, of_second, vocabulary, kMostRefinements, stop);
  for (int i = 0; i < kMostTries && !context_.stopped(); ++i) {
    auto answer = finder.find();
    if (answer == runtime::DifferenceAnswer::kNone && i == 0) nothing_.insert(pair);
    if (answer != runtime::DifferenceAnswer::kFound) return;
    auto trace = finder.trace();
    auto by = finder.excluded_by();
    while (by > 1 && finder.find(by - 1) == runtime::DifferenceAnswer::kFound) {
      trace = finder.trace();
      by = finder.excluded_by();
    }
    trace.points.resize(static_cast<std::size_t>(by) + 1);
    trace.points.back().happens.clear();
    const bool single = by > 0 && std::all_of(trace.points.begin(), trace.points.end() - 1,
                                              [](const auto& p) { return p.happens.size() == 1; });
    if (single) {
      auto converted = campaign_trace(a, std::move(trace), context_);
      if (!converted) return;
      converted->key = experiment_key(*converted);
      if (usable(*converted)) {
        found.emplace(converted->key, *std::move(converted));
        return;
      }
    }
    finder.block();
  }
}

std::optional<Experiment> ExperimentChooser::choose(
    const std::vector<std::string>& models,
    const std::function<bool(const harness::CampaignTrace&)>& usable) {
  std::vector<std::size_t> numbers;
  for (const auto& text : models) {
    const auto number = number_of(text);
    if (models_[number]->compilation) numbers.push_back(number);
  }
  std::map<std::string, harness::CampaignTrace> found;
  std::map<std::string, std::vector<bool>> admitted;  // by key: which of `numbers`
  std::vector<std::size_t> kinds;                     // places in `numbers` of models that differ
  const auto told_apart = [&](std::size_t i, std::size_t j) {
    return std::any_of(admitted.begin(), admitted.end(),
                       [&](const auto& entry) { return entry.second[i] != entry.second[j]; });
  };
  const auto look = [&](std::size_t i, std::size_t j) {
    const Pair pair(numbers[i], numbers[j]);
    if (nothing_.contains(pair) || told_apart(i, j)) return;
    find(pair, usable, found);
    for (const auto& [key, trace] : found) {
      if (admitted.contains(key)) continue;
      auto& goes = admitted[key];
      for (const auto number : numbers) goes.push_back(admits(*models_[number], trace));
    }
  };
  for (std::size_t i = 0; i < numbers.size() && !context_.stopped(); ++i) {
    if (same_as(numbers[i]) != numbers[i]) continue;
    bool differs = true;
    for (const auto j : kinds) {
      look(i, j);
      look(j, i);
      if (nothing_.contains({numbers[i], numbers[j]}) &&
          nothing_.contains({numbers[j], numbers[i]})) {
        same_[numbers[i]] = numbers[j];
        differs = false;
        break;
      }
    }
    if (differs) kinds.push_back(i);
  }
  if (context_.stopped()) return std::nullopt;
  std::optional<Experiment> best;
  for (const auto& [key, goes] : admitted) {
    const auto yes = static_cast<std::size_t>(std::count(goes.begin(), goes.end(), true));
    Experiment one{found.at(key), yes * (goes.size() - yes)};
    if (one.separated == 0) continue;
    const auto rank = [](const Experiment& e) {
      return std::tuple(~e.separated, e.trace.event_count());
    };
    if (!best || rank(one) < rank(*best)) best = std::move(one);
  }
  return best;
}

}  // namespace parallax::tools
