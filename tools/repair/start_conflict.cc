// Comparison of the starts of two models.
//
// Each model is a solver session that is asked about timepoint 0 alone. Its starts are enumerated
// over the fluents that are compared, at most 64, each excluded by a clause when it was found; the
// other model is asked about each of them under assumptions. Where the world has none of them, the
// world's own starts are enumerated, and those count of which the model excludes the fewest fluents
// by themselves. Cost: a solver call for each start, and for each fluent of a start.

#include "tools/repair/start_conflict.h"

#include <algorithm>
#include <utility>

#include "harness/discrete/stepped_model.h"
#include "harness/region/fluent_binding.h"
#include "runtime/session/solver_session.h"

namespace parallax::tools {

using compiler::AtomKind;
using compiler::Literal;
using runtime::SolveStatus;
using StartState = Evidence::State;

/// The starts of one model, over the compared fluents.
class StartComparison::States {
 public:
  /// `names`: of the model's fluents, by compared fluent.
  States(const compiler::CompiledModel& model, const std::map<std::string, std::string>& names,
         const std::atomic<bool>& stop)
      : asked_(model, runtime::make_cadical_solver(&stop)),
        listed_(model, runtime::make_cadical_solver(&stop)) {
    const compiler::AtomIndex index(model);
    for (const auto& [fluent, name] : names) {
      literals_.emplace(fluent, index.find(AtomKind::kHoldsAt, name, 0));
    }
  }

  bool has(const StartState& state) { return is_possible(state); }

  /// At most so many starts, in the order of the solver.
  std::vector<StartState> list(std::size_t most) {
    std::vector<StartState> out;
    while (out.size() < most && listed_.solve(0, {}) == SolveStatus::kSatisfiable) {
      auto& state = out.emplace_back();
      std::vector<Literal> other;
      for (const auto& [fluent, literal] : literals_) {
        const bool holds = literal && listed_.value(*literal);
        state.emplace(fluent, holds);
        if (literal) other.push_back(holds ? ~*literal : *literal);
      }
      if (other.empty()) break;
      listed_.add_clause(other);
    }
    std::sort(out.begin(), out.end());
    return out;
  }

  /// The fluents whose values here no start has.
  StartState impossible(const StartState& state) {
    StartState out;
    for (const auto& [fluent, holds] : state) {
      if (!is_possible({{fluent, holds}})) out.emplace(fluent, holds);
    }
    return out;
  }

 private:
  /// A fluent that the model settled and dropped is false.
  bool is_possible(const StartState& state) {
    std::vector<Literal> facts;
    for (const auto& [fluent, holds] : state) {
      const auto& literal = literals_.at(fluent);
      if (!literal && holds) return false;
      if (literal) facts.push_back(holds ? *literal : ~*literal);
    }
    return asked_.solve(0, facts) == SolveStatus::kSatisfiable;
  }

  runtime::SolverSession asked_, listed_;
  std::map<std::string, std::optional<Literal>> literals_;
};

StartComparison::StartComparison(const ScenarioModel& loaded, const Context& context)
    : loaded_(loaded), context_(context) {}
StartComparison::~StartComparison() = default;

std::unique_ptr<StartComparison> StartComparison::make(const ScenarioModel& loaded,
                                                       const Context& context) {
  if (loaded.world == nullptr || !loaded.scenario.mapping) return nullptr;
  std::unique_ptr<StartComparison> out(new StartComparison(loaded, context));
  const auto& of_world = loaded.world->model.fluents;
  for (const auto& fluent : loaded.compilation.model.fluents) {
    const auto ground = harness::ground_fluent(fluent.name);
    const auto* binding = loaded.scenario.mapping->find(ground.symbol);
    const auto* flag =
        binding == nullptr ? nullptr : std::get_if<harness::FlagBinding>(&binding->condition);
    if (flag == nullptr || flag->drawn == false) continue;
    const auto variable = harness::with_arguments(flag->variable, ground);
    const bool known = std::any_of(of_world.begin(), of_world.end(),
                                   [&](const auto& each) { return each.name == variable; });
    if (known) out->variables_.emplace(fluent.name, variable);
  }
  if (out->variables_.empty()) return nullptr;
  out->world_ = std::make_unique<States>(loaded.world->model, out->variables_, context.stop());
  return out;
}

namespace {

/// The names of the fluents in a model of their own.
std::map<std::string, std::string> own_start_names(
    const std::map<std::string, std::string>& variables) {
  std::map<std::string, std::string> out;
  for (const auto& [fluent, variable] : variables) out.emplace(fluent, fluent);
  return out;
}

/// Where the other state differs, with the values of `state`.
StartState start_difference(const StartState& state, const StartState& other) {
  StartState out;
  for (const auto& [fluent, holds] : state) {
    if (other.at(fluent) != holds) out.emplace(fluent, holds);
  }
  return out;
}

/// The difference to the nearest of these states, of which there are some.
StartState least_start_difference(const StartState& state, const std::vector<StartState>& others) {
  StartState out = start_difference(state, others.front());
  for (const auto& other : others) {
    auto own = start_difference(state, other);
    if (own.size() < out.size()) out = std::move(own);
  }
  return out;
}

}  // namespace

std::optional<StartConflict> StartComparison::conflict(const compiler::CompiledModel& model,
                                                       bool every) const {
  States own(model, own_start_names(variables_), context_.stop());
  StartConflict out;
  for (auto& start : own.list(kMostStarts)) {
    (world_->has(start) ? out.wanted : out.refused).push_back(std::move(start));
  }
  if (context_.stopped()) return std::nullopt;
  if (!out.wanted.empty()) {
    if (out.refused.empty() || !every) return std::nullopt;
    for (const auto& start : out.refused) {
      auto wrong = world_->impossible(start);
      if (wrong.empty()) wrong = least_start_difference(start, out.wanted);
      for (const auto& [fluent, holds] : wrong) out.differs.emplace(fluent, !holds);
    }
    return out;
  }
  out.is_shared = false;
  std::optional<std::size_t> least;
  for (auto& start : States(loaded_.world->model, variables_, context_.stop()).list(kMostStarts)) {
    auto wrong = own.impossible(start);
    if (wrong.empty() && !out.refused.empty()) wrong = least_start_difference(start, out.refused);
    if (!least || wrong.size() < *least) {
      out.wanted.clear();
      out.differs = wrong;
      least = wrong.size();
    }
    if (wrong.size() == *least) out.wanted.push_back(std::move(start));
  }
  if (out.wanted.empty() || context_.stopped()) return std::nullopt;
  return out;
}

StartComparison::Answer StartComparison::ask(const compiler::CompiledModel& model,
                                             const StartConflict& conflict) const {
  States own(model, own_start_names(variables_), context_.stop());
  Answer out;
  const auto has = [&](const StartState& start) { return own.has(start); };
  out.has_wanted = conflict.is_shared
                       ? std::all_of(conflict.wanted.begin(), conflict.wanted.end(), has)
                       : std::any_of(conflict.wanted.begin(), conflict.wanted.end(), has);
  out.missing = out.has_wanted ? 0 : variables_.size();
  for (const auto& start : conflict.wanted) {
    if (out.missing > 0) out.missing = std::min(out.missing, own.impossible(start).size());
  }
  for (const auto& start : own.list(kMostStarts)) out.refused += world_->has(start) ? 0 : 1;
  return out;
}

}  // namespace parallax::tools
