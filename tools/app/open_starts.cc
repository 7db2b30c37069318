#include "tools/app/open_starts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/artifact/symbol_table.h"
#include "compiler/base/codes/scenarios.h"
#include "harness/campaign/loop_stream.h"
#include "harness/campaign/start_draw.h"
#include "harness/campaign/trace_input.h"
#include "harness/campaign/trial.h"
#include "harness/discrete/model_simulator.h"
#include "runtime/session/solver_session.h"

namespace parallax::tools {
namespace {

using compiler::FluentId;
using compiler::Literal;

// Limit on the assignments of the compared fluents that are examined.
constexpr std::size_t kMostStates = 200;

/// The fluents in which the states differ, ascending.
std::vector<FluentId> differing_fluents(std::span<const std::vector<FluentId>> states) {
  std::set<FluentId> some;
  for (const auto& state : states) some.insert(state.begin(), state.end());
  const auto common = harness::common_fluents(states);
  std::vector<FluentId> out;
  std::set_difference(some.begin(), some.end(), common.begin(), common.end(),
                      std::back_inserter(out));
  return out;
}

/// Finds ignored fluents in which two initial states differ that agree on all compared ones.
class OpenFluents {
 public:
  OpenFluents(const compiler::CompiledModel& model, std::vector<FluentId> compared,
              std::vector<FluentId> ignored, Context& context)
      : model_(model),
        session_(model, runtime::make_cadical_solver(&context.stop())),
        compared_(std::move(compared)),
        ignored_(std::move(ignored)) {}

  std::set<FluentId> find() {
    for (std::size_t i = 0; i < kMostStates && open_.size() < ignored_.size(); ++i) {
      if (session_.solve(0, {}) != runtime::SolveStatus::kSatisfiable) break;
      const auto fixed = values_of(compared_);
      look(fixed);
      if (fixed.empty()) break;
      std::vector<Literal> other;
      for (const auto literal : fixed) other.push_back(~literal);
      session_.add_clause(other);
    }
    return std::move(open_);
  }

 private:
  std::vector<Literal> values_of(const std::vector<FluentId>& fluents) const {
    std::vector<Literal> out;
    for (const auto fluent : fluents) {
      const auto literal = model_.holds_at(fluent, 0);
      if (literal) out.push_back(session_.value(*literal) ? *literal : ~*literal);
    }
    return out;
  }

  /// Asks of each ignored fluent whether it can have the other value in a state that agrees on
  /// `fixed`.
  void look(const std::vector<Literal>& fixed) {
    std::map<FluentId, bool> here;
    for (const auto fluent : ignored_) {
      if (const auto literal = model_.holds_at(fluent, 0)) here[fluent] = session_.value(*literal);
    }
    for (const auto& [fluent, holds] : here) {
      if (open_.contains(fluent)) continue;
      auto assumed = fixed;
      const auto literal = *model_.holds_at(fluent, 0);
      assumed.push_back(holds ? ~literal : literal);
      if (session_.solve(0, assumed) == runtime::SolveStatus::kSatisfiable) open_.insert(fluent);
    }
  }

  const compiler::CompiledModel& model_;
  runtime::SolverSession session_;
  std::vector<FluentId> compared_, ignored_;
  std::set<FluentId> open_;
};

/// Parameters of a world that is a model, which it draws itself.
std::set<std::string> observed_by(const ScenarioModel& loaded) {
  std::set<std::string> out;
  if (!loaded.world) return out;
  for (const auto& one : harness::ModelSimulator::info_of(*loaded.world).parameters) {
    out.insert(one.name);
  }
  return out;
}

}  // namespace

void report_open_starts(const ScenarioModel& loaded, Context& context) {
  const auto& mapping = loaded.scenario.mapping;
  if (!mapping) return;
  const auto& model = loaded.compilation.model;
  const compiler::SymbolTable symbols(model);
  const harness::ModelFluents fluents(symbols);
  const auto observed = observed_by(loaded);
  std::vector<FluentId> compared, ignored;
  for (std::size_t i = 0; i < fluents.ground().size(); ++i) {
    const auto& fluent = fluents.ground()[i];
    const auto* binding = mapping->find(fluent.symbol);
    if (binding == nullptr || observed.contains(fluent.text)) continue;
    (binding->is_ignored() ? ignored : compared).push_back(fluents.id(i));
  }
  if (ignored.empty()) return;
  const auto open = OpenFluents(model, std::move(compared), std::move(ignored), context).find();
  struct Found {
    std::string first;
    std::size_t count = 0;
  };
  std::map<std::string, Found> by_symbol;
  for (std::size_t i = 0; i < fluents.ground().size(); ++i) {
    if (!open.contains(fluents.id(i))) continue;
    auto& found = by_symbol[fluents.ground()[i].symbol];
    if (found.count++ == 0) found.first = fluents.ground()[i].text;
  }
  for (const auto& [symbol, found] : by_symbol) {
    context.sink().warning(
        codes::kOpenStart, mapping->find(symbol)->source, found.first,
        found.count == 1 ? "" : fmt::format(" and {} more of it", found.count - 1));
  }
}

void UnrealisableStarts::note(const std::vector<FluentId>& state, std::span<const FluentId> open,
                              const compiler::SymbolTable& symbols,
                              const std::optional<std::string>& why) {
  std::set<Value> values;
  for (const auto fluent : open) {
    values.insert({symbols.name(fluent), runtime::contains(state, fluent)});
  }
  if (why) {
    found_.push_back({std::move(values), *why});
  } else {
    realised_.merge(values);
  }
}

void UnrealisableStarts::look(const harness::LoopStates& states,
                              const compiler::SymbolTable& symbols) {
  if (states.without_start.empty()) return;
  auto all = states.holds;
  for (const auto& state : states.without_start) all.push_back(state.holds);
  const auto open = differing_fluents(all);
  for (const auto& state : states.holds) note(state, open, symbols, std::nullopt);
  for (const auto& state : states.without_start) note(state.holds, open, symbols, state.reason);
}

base::Result<std::vector<harness::CampaignTrace>> UnrealisableStarts::look(
    harness::CampaignTrace trace, harness::TraceFeed& traces, std::size_t most) {
  const auto& scenario = loaded_.scenario;
  if (trace.other_initial_states != base::Known::kYes ||
      scenario.initial == harness::Initial::kFirst) {
    return std::vector{std::move(trace)};
  }
  auto compared = harness::compared_fluents(scenario, fluents_);
  std::sort(compared.begin(), compared.end());
  const auto starts = traces.starts(trace, compared);
  if (!starts) return context_.sink().already_reported();
  if (!*starts || (*starts)->more) return std::vector{std::move(trace)};
  const auto& states = (*starts)->states;
  const auto open = differing_fluents(states);
  std::vector<harness::CampaignTrace> out;
  for (const auto& state : states) {
    std::set<std::string> names;
    for (const auto fluent : state) names.insert(trace.symbols->name(fluent));
    const auto why = harness::why_no_start(scenario, fluents_.ground(), names);
    note(state, open, *trace.symbols, why);
    if (why || out.size() >= most) continue;
    if (&state == &states.front()) {
      out.push_back(trace);
      continue;
    }
    auto found = traces.from(trace, compared, state);
    if (!found) return context_.sink().already_reported();
    if (found->second) out.push_back(*std::move(found->second));
  }
  if (out.empty()) out.push_back(std::move(trace));
  return out;
}

void UnrealisableStarts::report() const {
  const auto& scenario = loaded_.scenario;
  const auto place_of = [&](const std::string& fluent) {
    const auto* binding = scenario.mapping->find(harness::ground_fluent(fluent).symbol);
    return binding == nullptr ? scenario.sampling_source : binding->source;
  };
  std::set<Value> fixed;
  constexpr std::size_t kMostShown = 5;
  std::size_t shown = 0;
  std::set<std::set<Value>> told;
  for (const auto& found : found_) {
    // A fluent with one value in every start is explained by that alone.
    bool is_explained = false;
    for (const auto& value : found.values) {
      const bool other = realised_.contains({value.fluent, !value.holds});
      if (realised_.contains(value) || !other) continue;
      is_explained = true;
      if (!fixed.insert(value).second) continue;
      context_.sink().warning(codes::kFixedStart, place_of(value.fluent), value.fluent,
                              value.holds ? "true" : "false", found.reason);
    }
    if (is_explained || !told.insert(found.values).second || ++shown > kMostShown) continue;
    std::vector<std::string> names;
    for (const auto& value : found.values) {
      if (value.holds) names.push_back("`" + value.fluent + "`");
    }
    const auto& first = found.values.empty() ? std::string() : found.values.begin()->fluent;
    context_.sink().warning(codes::kUnrealisableStart,
                            first.empty() ? scenario.sampling_source : place_of(first),
                            names.empty() ? "none of the fluents that are open"
                                          : fmt::format("{}", fmt::join(names, ", ")),
                            found.reason);
  }
}

}  // namespace parallax::tools
