#include "compiler/plan/plan_liveness.h"

#include <variant>

namespace parallax::compiler {
namespace {

/// Adds `more`; true if that was news.
bool include(RegisterSet& set, const RegisterSet& more) {
  const auto before = set.size();
  set.insert(more.begin(), more.end());
  return set.size() != before;
}

RegisterSet read_by(const PlanLocation& location) {
  auto out = registers_in(location.event);
  include(out, registers_in(location.success.formula));
  for (const auto& [name, value] : location.arguments) {
    if (const auto* id = std::get_if<ModelValueId>(&value)) out.insert(*id);
  }
  return out;
}

}  // namespace

const RegisterSet& PlanLiveness::at(const PlanTarget& target) const {
  static const RegisterSet kNone;
  if (const auto* location = std::get_if<LocationId>(&target)) return locations[location->index()];
  if (const auto* branch = std::get_if<BranchId>(&target)) return branches[branch->index()];
  return kNone;
}

PlanLiveness plan_liveness(const PlanGraph& graph) {
  PlanLiveness out;
  for (const auto& location : graph.locations) out.locations.push_back(read_by(location));
  for (const auto& branch : graph.branches) {
    out.branches.push_back(branch.free ? RegisterSet() : registers_in(branch.guard));
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
