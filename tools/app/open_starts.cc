#include "tools/app/open_starts.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/artifact/symbol_table.h"
#include "compiler/base/codes/scenarios.h"
#include "harness/campaign/trace_input.h"
#include "harness/discrete/model_simulator.h"
#include "runtime/session/solver_session.h"

namespace parallax::tools {
namespace {

using compiler::FluentId;
using compiler::Literal;

// Limit on the assignments of the compared fluents that are examined.
constexpr std::size_t kMostStates = 200;

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

}  // namespace parallax::tools
