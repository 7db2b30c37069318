#include "compiler/plan/plan_state.h"

#include <limits>

namespace parallax::compiler {

std::vector<std::uint32_t> state_key(const PlanState& state, const ValueStore& values,
                                     bool counters) {
  std::vector<std::uint32_t> key;
  key.reserve(2 + state.frames.size() * 12 + state.guards.size() * 4 + state.stack.size());
  key.push_back(static_cast<std::uint32_t>(state.frames.size()));
  key.push_back(static_cast<std::uint32_t>(state.guards.size()));
  for (const auto& frame : state.frames) {
    const std::uint32_t kinds = static_cast<std::uint32_t>(frame.kind) * 4U +
                                static_cast<std::uint32_t>(frame.pending.kind);
    key.insert(key.end(), {frame.unit, frame.pc, frame.link, frame.base, frame.guard_base, kinds,
                           frame.skip_to, frame.failure.index(), frame.pending.frame,
                           frame.pending.exit, frame.pending.value.index()});
  }
  for (const auto& guard : state.guards) {
    key.insert(key.end(), {guard.cleanup ? 1U : 0U, guard.index, guard.frame, guard.height});
  }
  for (const auto value : state.stack) {
    const bool hidden = !counters && values.kind(value) == ValueKind::kCounter;
    key.push_back(hidden ? std::numeric_limits<std::uint32_t>::max() : value.index());
  }
  return key;
}

}  // namespace parallax::compiler
