#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "compiler/plan/plan_code.h"
#include "compiler/plan/plan_value.h"

namespace parallax::compiler {

enum class FrameKind : std::uint8_t { kCall, kHandler, kCleanup };
enum class PendingKind : std::uint8_t { kNone, kExit, kFail };

/// What a clean-up interrupted: a jump out of the frames above `frame`, or the end of the plan.
struct Pending {
  PendingKind kind = PendingKind::kNone;
  std::uint32_t frame = 0;
  std::uint32_t exit = 0;
  ValueId value;  // kExit: carried along; kFail: the failure
};

/// One activation of a unit. Everything is an index, so equal activations compare equal.
struct PlanFrame {
  std::uint32_t unit = 0;
  std::uint32_t pc = 0;
  std::uint32_t link = 0;        // the frame of the unit around this one in the source
  std::uint32_t base = 0;        // where its variables start on the stack
  std::uint32_t guard_base = 0;  // guards below belong to other frames
  FrameKind kind = FrameKind::kCall;
  std::uint32_t skip_to = 0;  // kHandler: guards from here up to guard_base are asleep
  ValueId failure;            // kHandler: what it handles
  Pending pending;            // kCleanup
  // Not part of the state's identity: performs on the way here, when the frame was made.
  std::uint32_t performs = 0;
};

/// An active with-failure-handling or unwind-protect.
struct PlanGuard {
  bool cleanup = false;
  std::uint32_t index = 0;  // the handler table, or the clean-up's unit
  std::uint32_t frame = 0;
  std::uint32_t height = 0;  // of the stack when it began
};

/// A perform that a branch of a `par` waits at for its turn.
struct PlanTurn {
  ValueId designator;
  DatumId form;
};

struct PlanPar;

/// A branch of a `par` that is not running: what it has on top of what all branches share. They
/// begin at the same height, so that the indices in it are right whenever it is put back.
struct PlanBranchState {
  bool started = false;
  bool done = false;
  ValueId result;  // done
  std::optional<PlanTurn> turn;
  std::vector<PlanFrame> frames;
  std::vector<PlanGuard> guards;
  std::vector<ValueId> stack;
  std::vector<PlanPar> pars;  // at most one: of a branch that is itself in branches
};

/// An active `par` whose branches take turns, perform by perform.
struct PlanPar {
  std::uint32_t frames = 0;  // what the branches share
  std::uint32_t guards = 0;
  std::uint32_t height = 0;
  std::size_t active = 0;  // the branch whose state is in place
  DatumId form;
  std::vector<PlanBranchState> branches;
};

/// All that the rest of an execution depends on.
struct PlanState {
  std::vector<PlanFrame> frames;
  std::vector<PlanGuard> guards;
  std::vector<ValueId> stack;
  std::vector<PlanPar> pars;   // outermost first
  std::uint32_t performs = 0;  // on the path so far; not part of the state's identity
  std::uint32_t missed = 0;    // references that failed since the last perform; the same
};

/// Calls visit(value) for every value that the state holds, also in branches that wait.
void for_each_value(const PlanState& state, const std::function<void(ValueId)>& visit);

/// Equal for equal states. Without `counters`, states that differ only in how often an endless loop
/// has run are equal: coming back to such a state is a cycle, not news.
std::vector<std::uint32_t> state_key(const PlanState& state, const ValueStore& values,
                                     bool counters);

}  // namespace parallax::compiler
