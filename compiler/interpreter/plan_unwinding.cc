// Failures, handlers and clean-ups. A handler runs on top of the failed body, as in CRAM, where
// conditions are signalled before the stack is unwound: it sees the outer handlers only, and the
// clean-ups of the body run once it has decided. That holds within one task: a failure that finds
// no handler there ends the task with its clean-ups, and only then the handlers around it are
// asked. A Lisp error leaves a task in an envelope, which is a plan failure.
#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "compiler/base/codes/plans.h"
#include "compiler/interpreter/plan_machine.h"

namespace parallax::compiler {
namespace {

PlanFrame frame_on_top(const PlanState& state, std::uint32_t unit, std::uint32_t link,
                       FrameKind kind) {
  PlanFrame frame;
  frame.unit = unit;
  frame.link = link;
  frame.base = static_cast<std::uint32_t>(state.stack.size());
  frame.guard_base = static_cast<std::uint32_t>(state.guards.size());
  frame.kind = kind;
  frame.performs = state.performs;
  return frame;
}

/// Drops the top frame with its variables and guards.
PlanFrame drop_frame(PlanState& state) {
  const auto frame = state.frames.back();
  state.frames.pop_back();
  state.stack.resize(frame.base);
  state.guards.resize(frame.guard_base);
  return frame;
}

/// Once a handler runs, the body that failed never goes on; all that is left of it are its
/// clean-ups and its special variables. Without the rest, failures of different performs reach
/// their handler in one state.
void drop_abandoned(PlanState& state, std::size_t handling) {
  const auto stays = [&](std::size_t guard) {
    const auto kind = state.guards[guard].kind;
    return kind == GuardKind::kCleanup || kind == GuardKind::kSpecial;
  };
  auto keep = state.guards.size() - 1;
  while (keep > handling && !stays(keep)) --keep;
  const auto guard = state.guards[keep];
  state.guards.resize(keep + 1);
  state.frames.resize(std::size_t{guard.frame} + 1);
  state.frames.back().pc = 0;  // it goes on at an exit or not at all
  std::size_t height = guard.height;
  for (const auto& kept : state.guards) {
    if (kept.kind == GuardKind::kSpecial) height = std::max(height, std::size_t{kept.height} + 1);
  }
  state.stack.resize(height);
}

GuardKind guard_kind(PlanOp op) {
  if (op == PlanOp::kPushTask) return GuardKind::kTask;
  return op == PlanOp::kPushCleanup ? GuardKind::kCleanup : GuardKind::kHandlers;
}

/// The clean-up of an evaporated branch that runs, if one does: a frame above the border's.
std::optional<std::size_t> last_cleanup(const PlanState& state, const PlanGuard& border) {
  for (auto f = std::size_t{border.frame} + 1; f < state.frames.size(); ++f) {
    const auto& frame = state.frames[f];
    if (frame.kind == FrameKind::kCleanup && frame.pending.kind != PendingKind::kNone) return f;
  }
  return std::nullopt;
}

}  // namespace

void PlanMachine::push_guard(PlanState& state, const PlanInstruction& instruction) {
  const auto frame = static_cast<std::uint32_t>(state.frames.size() - 1);
  const auto height = static_cast<std::uint32_t>(state.stack.size());
  const auto kind = guard_kind(instruction.op);
  state.guards.push_back({kind, instruction.a, frame, height});
  if (kind != GuardKind::kHandlers) return;
  if (handlers_met_.size() <= instruction.a) handlers_met_.resize(code_.handlers.size());
  handlers_met_[instruction.a] = true;
}

void PlanMachine::run_cleanup(PlanState& state, const PlanInstruction& instruction) {
  const auto frame = static_cast<std::uint32_t>(state.frames.size() - 1);
  state.frames.push_back(frame_on_top(state, instruction.a, frame, FrameKind::kCleanup));
}

/// The handler declined: the next matching clause of its form is asked, then those further out.
PlanMachine::Step PlanMachine::end_handler(PlanState& state) {
  const auto handler = drop_frame(state);
  return search(state, handler.failure, std::size_t{handler.skip_to} + 1,
                std::size_t{handler.clause} + 1);
}

PlanMachine::Step PlanMachine::end_cleanup(PlanState& state) {
  const auto cleanup = drop_frame(state);
  if (cleanup.pending.kind == PendingKind::kNone) return {};
  return unwind(state, cleanup.pending);
}

PlanMachine::Step PlanMachine::fail_value(PlanState& state, const PlanInstruction& instruction) {
  const auto id = state.stack.back();
  state.stack.pop_back();
  const auto& value = values_[id];
  if (value.kind == ValueKind::kFailure) return raise(state, id);
  const auto known =
      value.kind == ValueKind::kSymbol ? code_.classes.canonical(value.text) : std::nullopt;
  if (known) return raise(state, values_.failure(*known));
  sink_.error(codes::kUnknownFailureClass, data_.source(instruction.source), values_.print(id));
  return StopError{};
}

std::optional<PlanStop> PlanMachine::raise(PlanState& state, ValueId failure) {
  return search(state, failure, state.guards.size());
}

/// Looks for a handler among the guards below `limit`, innermost first, and in the first of them
/// from `clause` on. A frame that is handling a failure hides the guards between the one it belongs
/// to and its own.
PlanMachine::Step PlanMachine::search(PlanState& state, ValueId failure, std::size_t limit,
                                      std::size_t clause) {
  for (auto f = state.frames.size(); f-- > 0;) {
    const auto& frame = state.frames[f];
    for (auto g = limit; g-- > frame.guard_base;) {
      const auto guard = state.guards[g];
      const bool border = guard.kind == GuardKind::kTask || guard.kind == GuardKind::kEvaporated;
      if (border) return leave_task(state, g, failure);
      if (guard.kind != GuardKind::kHandlers) continue;
      const auto& clauses = code_.handlers[guard.index];
      const auto error = values_.enveloped(failure);
      const auto first = std::exchange(clause, 0);
      for (auto i = first; i < clauses.size(); ++i) {
        const bool opens = clauses[i].opens;
        if (opens && (!error || first > 0)) continue;
        const auto signalled = opens ? *error : failure;
        if (!code_.classes.is_a(values_[signalled].text, clauses[i].failure_class)) continue;
        drop_abandoned(state, g);
        auto handler = frame_on_top(state, clauses[i].unit, guard.frame, FrameKind::kHandler);
        handler.skip_to = static_cast<std::uint32_t>(g);
        handler.clause = static_cast<std::uint32_t>(i);
        handler.failure = failure;
        handlers_run_.push_back(clauses[i].unit);
        state.frames.push_back(handler);
        state.stack.push_back(signalled);
        return {};
      }
    }
    limit = std::min(limit, std::size_t{frame.guard_base});
    if (frame.kind == FrameKind::kHandler) limit = std::min(limit, std::size_t{frame.skip_to});
  }
  return unwind(state, {PendingKind::kFail, 0, 0, failure});
}

/// No handler of the task takes the failure: its clean-ups run, then the task around it fails. What
/// fails in the clean-ups of an evaporated branch is lost, and what ended the branch goes on.
PlanMachine::Step PlanMachine::leave_task(PlanState& state, std::size_t border, ValueId failure) {
  if (state.guards[border].kind == GuardKind::kTask) {
    const auto index = static_cast<std::uint32_t>(border);
    return unwind(state, {PendingKind::kCross, state.guards[border].frame, index, failure});
  }
  if (const auto cleanup = last_cleanup(state, state.guards[border])) {
    return unwind(state, state.frames[*cleanup].pending);
  }
  return unwind(state, {PendingKind::kFail, 0, 0, failure});
}

ValueId PlanMachine::leaving_task(ValueId failure) const {
  return code_.classes.is_lisp_error(values_[failure].text) ? values_.envelope(failure) : failure;
}

/// A jump. Out of the clean-up of an evaporated branch into that branch, of which nothing else is
/// left, it only ends the clean-up.
PlanMachine::Step PlanMachine::jump_out(PlanState& state, const Pending& pending) {
  for (auto guard = state.guards.rbegin(); guard != state.guards.rend(); ++guard) {
    if (guard->kind != GuardKind::kEvaporated || guard->frame > pending.frame) continue;
    const auto cleanup = last_cleanup(state, *guard);
    if (cleanup && pending.frame < *cleanup) return unwind(state, state.frames[*cleanup].pending);
    break;
  }
  return unwind(state, pending);
}

/// Leaves frames and guards up to the target, clean-up by clean-up.
PlanMachine::Step PlanMachine::unwind(PlanState& state, Pending pending) {
  const bool exits = pending.kind == PendingKind::kExit;
  const bool crosses = pending.kind == PendingKind::kCross;
  const auto target =
      exits ? state.frames[pending.frame].guard_base + code_.exits[pending.exit].guards
            : (crosses ? pending.exit : 0U);
  PlanGuard last;
  while (state.guards.size() > target) {
    last = state.guards.back();
    state.guards.pop_back();
    if (last.kind != GuardKind::kCleanup) continue;
    state.frames.resize(std::size_t{last.frame} + 1);
    state.stack.resize(last.height);
    auto cleanup = frame_on_top(state, last.index, last.frame, FrameKind::kCleanup);
    cleanup.pending = pending;
    state.frames.push_back(cleanup);
    return {};
  }
  if (crosses) {
    pending.value = leaving_task(pending.value);
    const bool branch = !state.pars.empty() && target == state.pars.back().guards;
    if (branch) return fail_branch(state, pending.value);
    state.frames.resize(std::size_t{pending.frame} + 1);
    state.frames.back().pc = 0;  // it goes on at an exit or not at all
    state.stack.resize(last.height);
    return search(state, pending.value, state.guards.size());
  }
  if (!exits) {
    const auto cause = values_.enveloped(pending.value).value_or(pending.value);
    return StopFailed{values_[pending.value].text, values_[cause].text};
  }
  state.frames.resize(std::size_t{pending.frame} + 1);
  auto& frame = state.frames.back();
  const auto& exit = code_.exits[pending.exit];
  state.stack.resize(frame.base + std::size_t{exit.height});
  state.stack.push_back(pending.value);
  frame.pc = exit.pc;
  return {};
}

}  // namespace parallax::compiler
