#include "compiler/plan/plan_liveness.h"

#include <string>
#include <variant>

#include "compiler/plan/binding_template.h"

namespace parallax::compiler {
namespace {

/// Adds `more`; true if that was news.
bool include(RegisterSet& set, const RegisterSet& more) {
  const auto before = set.size();
  set.insert(more.begin(), more.end());
  return set.size() != before;
}

RegisterSet read_by(const RegisterNames& names, const PlanLocation& location) {
  auto out = names.in(location.event);
  include(out, names.in(location.success.formula));
  for (const auto& [name, value] : location.arguments) {
    if (const auto* text = std::get_if<std::string>(&value)) include(out, names.in(*text));
  }
  return out;
}

}  // namespace

RegisterNames::RegisterNames(const PlanGraph& graph) {
  for (std::size_t i = 0; i < graph.values.size(); ++i) {
    const auto id = graph.values.id_at(i);
    ids_.emplace(graph.values[id].name, id);
  }
}

std::optional<ModelValueId> RegisterNames::find(std::string_view name) const {
  const auto found = ids_.find(name);
  if (found == ids_.end()) return std::nullopt;
  return found->second;
}

RegisterSet RegisterNames::in(std::string_view text) const {
  RegisterSet out;
  for (std::size_t i = text.find('?'); i != std::string_view::npos; i = text.find('?', i + 1)) {
    if (const auto id = find(text.substr(i, variable_length(text.substr(i))))) out.insert(*id);
  }
  return out;
}

const RegisterSet& PlanLiveness::at(const PlanTarget& target) const {
  static const RegisterSet kNone;
  if (const auto* location = std::get_if<LocationId>(&target)) return locations[location->index()];
  if (const auto* branch = std::get_if<BranchId>(&target)) return branches[branch->index()];
  return kNone;
}

PlanLiveness plan_liveness(const PlanGraph& graph) {
  const RegisterNames names(graph);
  PlanLiveness out;
  for (const auto& location : graph.locations) out.locations.push_back(read_by(names, location));
  for (const auto& branch : graph.branches) {
    out.branches.push_back(branch.free ? RegisterSet() : names.in(branch.guard));
  }
  for (bool changed = !graph.values.empty(); changed;) {
    changed = false;
    for (auto i = graph.branches.size(); i-- > 0;) {
      const auto& branch = graph.branches[graph.branches.id_at(i)];
      changed = include(out.branches[i], out.at(branch.if_true)) || changed;
      changed = include(out.branches[i], out.at(branch.if_false)) || changed;
    }
    for (auto i = graph.locations.size(); i-- > 0;) {
      const auto& location = graph.locations[graph.locations.id_at(i)];
      auto behind = out.at(location.on_success);
      if (location.result) behind.erase(*location.result);
      changed = include(out.locations[i], behind) || changed;
      changed = include(out.locations[i], out.at(location.on_failure)) || changed;
    }
  }
  return out;
}

}  // namespace parallax::compiler
