#include "runtime/enumerate/start_groups.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace parallax::runtime {

using compiler::FluentId;

std::vector<std::vector<FluentId>> connected_at_start(const compiler::CompiledModel& model,
                                                      std::span<const FluentId> fluents) {
  std::map<std::int32_t, FluentId> told;  // by variable
  for (const auto fluent : fluents) {
    if (const auto literal = model.holds_at(fluent, 0)) told.emplace(literal->var(), fluent);
  }
  std::set<std::int32_t> others;  // atoms that are not about the state at 0
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    using Kind = compiler::AtomKind;
    const bool at_start = atom.kind == Kind::kHoldsAt && atom.time == 0;
    if (!at_start && atom.kind != Kind::kAuxiliary) others.insert(atom.variable);
  });
  std::map<std::int32_t, std::int32_t> parent;
  const auto root = [&](std::int32_t variable) {
    parent.try_emplace(variable, variable);
    while (parent.at(variable) != variable) {
      auto& up = parent.at(variable);
      up = parent.at(up);
      variable = up;
    }
    return variable;
  };
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    const auto clause = model.clauses[i];
    const bool is_at_start = std::none_of(clause.begin(), clause.end(), [&](const auto literal) {
      return others.contains(literal.var());
    });
    if (!is_at_start || clause.empty()) continue;
    const auto first = root(clause.front().var());
    for (const auto literal : clause) parent.at(root(literal.var())) = first;
  }
  std::map<std::int32_t, std::vector<FluentId>> groups;
  for (const auto& [variable, fluent] : told) groups[root(variable)].push_back(fluent);
  std::vector<std::vector<FluentId>> out;
  for (auto& [variable, group] : groups) {
    std::sort(group.begin(), group.end());
    out.push_back(std::move(group));
  }
  return out;
}

}  // namespace parallax::runtime
