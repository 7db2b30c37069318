// Globals while a plan runs: their own values, and those that a task has rebound.
#include <algorithm>

#include "compiler/base/codes/plans.h"
#include "compiler/interpreter/plan_machine.h"

namespace parallax::compiler {

PlanMachine::Step PlanMachine::load_global(PlanState& state, const PlanInstruction& instruction) {
  const auto rebound = instruction.b == 0 ? special(state, instruction.a) : std::nullopt;
  if (rebound) {
    state.stack.push_back(state.stack[*rebound]);
    return {};
  }
  const auto set = instruction.b == 0 ? state.links.heap.global(instruction.a) : std::nullopt;
  if (set) {
    state.stack.push_back(*set);
    return {};
  }
  if (const auto value = instruction.a < globals_.size() ? globals_[instruction.a] : std::nullopt) {
    state.stack.push_back(*value);
    return {};
  }
  const auto& global = code_.globals[instruction.a];
  report(codes::kUnboundPlanVariable, instruction.source, global.name)
      .note(data_.source(global.source),
            blame_ ? "globals get their values behind the macros" : "it is defined only here");
  return StopError{};
}

/// Sets the binding of this task if there is one, else the global value that all tasks see.
PlanMachine::Step PlanMachine::store_special(PlanState& state, const PlanInstruction& instruction) {
  if (const auto rebound = special(state, instruction.a)) {
    state.stack[*rebound] = state.stack.back();
    return {};
  }
  state.links.heap.set_global(instruction.a, state.stack.back());
  return {};
}

/// From here on the global means a variable of the running frame.
PlanMachine::Step PlanMachine::bind_special(PlanState& state, const PlanInstruction& instruction) {
  const auto frame = static_cast<std::uint32_t>(state.frames.size() - 1);
  const auto place = state.frames[frame].base + instruction.b;
  state.guards.push_back({GuardKind::kSpecial, instruction.a, frame, place});
  return {};
}

namespace {

/// A handler does not see the remains of ended branches, whose clean-ups are still to run.
bool left_over(const PlanState& state, std::size_t guard) {
  const auto at = [&](std::size_t index) {
    return state.guards.begin() + static_cast<std::ptrdiff_t>(index);
  };
  const auto evaporated = [](const PlanGuard& kept) { return kept.kind == GuardKind::kEvaporated; };
  return std::any_of(state.frames.begin(), state.frames.end(), [&](const PlanFrame& frame) {
    const bool covers =
        frame.kind == FrameKind::kHandler && frame.skip_to < guard && guard < frame.guard_base;
    return covers && std::any_of(at(frame.skip_to), at(guard + 1), evaporated);
  });
}

}  // namespace

/// Where the task that runs has rebound the global, if it has: a task sees no other's bindings.
std::optional<std::size_t> PlanMachine::special(const PlanState& state,
                                                std::uint32_t global) const {
  for (auto g = state.guards.size(); g-- > 0;) {
    if (left_over(state, g)) continue;
    const auto& guard = state.guards[g];
    if (guard.kind == GuardKind::kSpecial && guard.index == global) return guard.height;
    const bool border = guard.kind == GuardKind::kTask || guard.kind == GuardKind::kEvaporated;
    if (border) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace parallax::compiler
