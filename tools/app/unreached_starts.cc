#include "tools/app/unreached_starts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "compiler/artifact/symbol_table.h"
#include "compiler/base/words.h"
#include "harness/campaign/loop_stream.h"
#include "harness/campaign/start_draw.h"
#include "runtime/session/solver_session.h"

namespace parallax::tools {

namespace {

using State = std::vector<compiler::FluentId>;

constexpr std::size_t kMostCounted = 100;
constexpr std::size_t kMostNamed = 3;

/// Excludes an initial state from further answers. False: it has no fluent that could be excluded.
bool exclude(const compiler::CompiledModel& model, const std::vector<compiler::FluentId>& fluents,
             const State& state, runtime::SolverSession& session) {
  std::vector<compiler::Literal> other;
  for (const auto fluent : fluents) {
    const auto literal = model.holds_at(fluent, 0);
    if (literal) other.push_back(runtime::contains(state, fluent) ? ~*literal : *literal);
  }
  if (other.empty()) return false;
  session.add_clause(other);
  return true;
}

}  // namespace

UnreachedStarts::UnreachedStarts(const ScenarioModel& loaded) : loaded_(&loaded) {
  const compiler::SymbolTable symbols(loaded.compilation.model);
  fluents_ = harness::compared_fluents(loaded.scenario, harness::ModelFluents(symbols));
  std::sort(fluents_.begin(), fluents_.end());
}

void UnreachedStarts::note(const harness::CampaignTrace& trace) {
  State own;
  for (const auto fluent : fluents_) {
    if (runtime::contains(trace.points.front().holds, fluent)) own.push_back(fluent);
  }
  reached_.insert(std::move(own));
  if (trace.other_initial_states != base::Known::kNo) awaited_.insert(trace.number);
}

void UnreachedStarts::note(std::int64_t trace, const std::vector<State>& states) {
  reached_.insert(states.begin(), states.end());
  awaited_.erase(trace);
}

std::vector<std::string> UnreachedStarts::texts(Context& context) const {
  if (!awaited_.empty() || reached_.empty()) return {};
  const auto& model = loaded_->compilation.model;
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  for (const auto& state : reached_) {
    if (!exclude(model, fluents_, state, session)) return {};
  }
  std::vector<State> found;
  auto status = runtime::SolveStatus::kUnsatisfiable;
  while (found.size() < kMostCounted &&
         (status = session.solve(0, {})) == runtime::SolveStatus::kSatisfiable) {
    auto& state = found.emplace_back();
    for (const auto fluent : fluents_) {
      const auto literal = model.holds_at(fluent, 0);
      if (literal && session.value(*literal)) state.push_back(fluent);
    }
    exclude(model, fluents_, state, session);
  }
  if (found.empty()) return {};
  std::sort(found.begin(), found.end());
  auto all = found;
  all.insert(all.end(), reached_.begin(), reached_.end());
  const auto common = harness::common_fluents(all);
  const compiler::SymbolTable symbols(model);
  std::vector<std::string> names;
  for (const auto& state : found) {
    if (names.size() == kMostNamed) break;
    std::vector<std::string> words;
    for (const auto fluent : state) {
      if (!runtime::contains(common, fluent)) words.push_back(symbols.name(fluent));
    }
    names.push_back(words.empty() ? "none of what differs holds"
                                  : fmt::format("{}", fmt::join(words, ", ")));
  }
  const bool more = status != runtime::SolveStatus::kUnsatisfiable;
  return {fmt::format(
      "{}{} {} to no trace up to the horizon and {} not simulated: {}{}", more ? "at least " : "",
      base::counted(static_cast<std::int64_t>(found.size()), "initial state", "initial states"),
      found.size() == 1 ? "leads" : "lead", found.size() == 1 ? "is" : "are",
      fmt::join(names, "; "), found.size() > names.size() ? "; ..." : "")};
}

}  // namespace parallax::tools
