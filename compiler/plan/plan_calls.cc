#include <fmt/core.h>

#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/plan_machine.h"

namespace parallax::compiler {

using base::DiagnosticCode;

/// The end of a unit: its result replaces its variables.
PlanMachine::Step PlanMachine::leave(PlanState& state) {
  const auto result = state.stack.back();
  const auto base = state.frames.back().base;
  state.frames.pop_back();
  state.stack.resize(base);
  state.stack.push_back(result);
  return {};
}

PlanMachine::Step PlanMachine::call(PlanState& state, const PlanInstruction& instruction) {
  const auto& unit = code_.units[instruction.a];
  std::uint32_t depth = 0;
  const PlanFrame* outermost = nullptr;
  // What lies between a handler and the frame it belongs to has failed and is not active any more.
  for (auto f = static_cast<std::uint32_t>(state.frames.size()); f-- > 0;) {
    const auto& active = state.frames[f];
    if (active.unit == instruction.a) {
      outermost = &active;
      ++depth;
    }
    if (active.kind == FrameKind::kHandler) f = active.link + 1;
  }
  if (depth >= limits_.max_call_depth) {
    if (outermost->performs != state.performs) return StopBound{unit.name, instruction.source};
    sink_.error(DiagnosticCode::kPlanRecursion, data_.source(instruction.source), unit.name,
                limits_.max_call_depth);
    return StopError{};
  }
  PlanFrame frame;
  frame.unit = instruction.a;
  frame.link = instruction.op == PlanOp::kCallLocal ? linked(state, instruction.b) : 0;
  frame.base = static_cast<std::uint32_t>(state.stack.size()) - unit.parameters;
  frame.guard_base = static_cast<std::uint32_t>(state.guards.size());
  frame.performs = state.performs;
  state.frames.push_back(frame);
  return {};
}

std::optional<PlanStop> PlanMachine::enter(PlanState& state, std::uint32_t unit,
                                           const std::vector<ValueId>& arguments, DatumId form) {
  state.stack.insert(state.stack.end(), arguments.begin(), arguments.end());
  return call(state, {PlanOp::kCall, unit, 0, form});
}

/// The elements of the list on top become the arguments of the instruction that follows.
PlanMachine::Step PlanMachine::apply(PlanState& state, const PlanInstruction& instruction) {
  const auto list = state.stack.back();
  state.stack.pop_back();
  const auto items = values_.elements(list).value_or(std::vector<ValueId>());
  auto& frame = state.frames.back();
  auto next = code_.units[frame.unit].code[frame.pc++];
  const bool is_builtin = next.op == PlanOp::kBuiltin;
  const auto count = static_cast<std::uint32_t>(items.size());
  const auto parameters = is_builtin ? 0U : code_.units[next.a].parameters;
  const auto least = is_builtin ? plan_builtins()[next.a].min_arguments : parameters;
  const auto most = is_builtin ? plan_builtins()[next.a].max_arguments : parameters;
  if (count < least || count > most) {
    return error(
        DiagnosticCode::kPlanArguments, instruction,
        fmt::format("the function takes at {} {} arguments, the list has {}",
                    count < least ? "least" : "most", count < least ? least : most, count));
  }
  state.stack.insert(state.stack.end(), items.begin(), items.end());
  if (!is_builtin) return call(state, next);
  next.b = count;
  return builtin(state, next);
}

}  // namespace parallax::compiler
