// The machine's services for rules and designators: functions that run on their own, identities and
// links of designators.
#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "compiler/base/codes/plans.h"
#include "compiler/interpreter/plan_machine.h"

namespace parallax::compiler {

void drop_dead_links(PlanState& state, std::span<const ValueId> more, const ValueStore& values) {
  // The caller of a computation may refer to more than the computation's state shows.
  if (state.links.chains.empty() || state.links.floor > 1) return;
  std::set<std::uint32_t> identities;
  std::set<ModelValueId> registers;
  const auto note = [&](ValueId id) {
    const auto& value = values[id];
    identities.insert(value.identities.begin(), value.identities.end());
    registers.insert(value.registers.begin(), value.registers.end());
  };
  for (const auto value : more) note(value);
  auto chains = std::exchange(state.links.chains, {});
  for_each_value(state, note);
  state.links.chains = std::move(chains);
  const auto alive = [&](ValueId id) {
    const auto& value = values[id];
    return value.kind == ValueKind::kModel ? registers.contains(value.model)
                                           : identities.contains(value.identity);
  };
  // The last value of a living chain is alive, and so is everything in it.
  std::vector<bool> kept(state.links.chains.size(), false);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const auto& chain = state.links.chains[i];
      if (kept[i] || std::none_of(chain.begin(), chain.end(), alive)) continue;
      kept[i] = changed = true;
      note(chain.back());
    }
  }
  std::vector<std::vector<ValueId>> out;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    auto& chain = state.links.chains[i];
    std::erase_if(chain, [&](ValueId id) { return !alive(id); });
    if (kept[i] && chain.size() > 1) out.push_back(std::move(chain));
  }
  state.links.chains = std::move(out);
}

void drop_dead_cells(PlanState& state, std::span<const ValueId> more, const ValueStore& values) {
  auto& heap = state.links.heap;
  // The caller of a computation may refer to more than the computation's state shows.
  if (heap.cells.empty() || state.links.floor > 1) return;
  auto cells = std::exchange(heap.cells, {});
  std::set<std::uint32_t> alive;
  std::vector<std::uint32_t> open;
  const auto note = [&](ValueId id) {
    for (const auto identity : values[id].identities) {
      if (alive.insert(identity).second) open.push_back(identity);
    }
  };
  for_each_value(state, note);
  for (const auto value : more) note(value);
  const auto lives = [&](std::uint32_t cell) { return cell <= heap.kept || alive.contains(cell); };
  for (const auto& [cell, content] : cells) {
    if (cell <= heap.kept) note(content);
  }
  while (!open.empty()) {
    const auto next = open.back();
    open.pop_back();
    const auto found = std::lower_bound(
        cells.begin(), cells.end(), next,
        [](const auto& cell, std::uint32_t number) { return cell.first < number; });
    if (found != cells.end() && found->first == next) note(found->second);
  }
  std::erase_if(cells, [&](const auto& cell) { return !lives(cell.first); });
  heap.cells = std::move(cells);
}

void PlanMachine::report(const BuiltinFailure& failure, std::uint32_t builtin, DatumId form) {
  const auto name = plan_builtins()[builtin].name;
  const bool own = data_.in_library(form) || name.front() == '%';
  const auto caller = own ? name_at(place_of(form)) : std::string(name);
  switch (failure.kind) {
    case BuiltinError::kRaise:
    case BuiltinError::kValue:
      report(codes::kPlanValue, form, caller, failure.text);
      break;
    case BuiltinError::kModelComparison:
      report(codes::kModelComparison, form, caller);
      break;
    case BuiltinError::kModelList:
      report(codes::kModelList, form, caller);
      break;
  }
}

PlanState PlanMachine::computation(std::uint32_t unit, const std::vector<ValueId>& arguments,
                                   DesignatorLinks links) const {
  PlanState state;
  state.links = std::move(links);
  state.links.floor = state.links.next;
  state.frames.resize(2);
  state.frames[0].unit = code_.halt;
  state.frames[1].unit = unit;
  state.stack = arguments;
  return state;
}

void PlanMachine::refresh_links(PlanState& state, std::span<const ValueId> more) const {
  state.links.identities = code_.identities;
  if (!code_.identities && state.links.heap.cells.empty()) return;
  drop_dead_links(state, more, values_);
  drop_dead_cells(state, more, values_);
  auto last = state.links.heap.kept;
  if (!state.links.heap.cells.empty()) last = std::max(last, state.links.heap.cells.back().first);
  const auto note = [&](ValueId value) {
    const auto& identities = values_[value].identities;
    if (!identities.empty()) last = std::max(last, identities.back());
  };
  for_each_value(state, note);
  for (const auto value : more) note(value);
  state.links.next = std::max(state.links.floor, last + 1);
}

}  // namespace parallax::compiler
