// Function values and multiple values on the machine. A function value that shares variables with
// the code around it holds the number of a frame and a place on the stack. It must not come to lie
// below either: that is checked wherever a value moves down.
#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/base/codes/plans.h"
#include "compiler/base/words.h"
#include "compiler/interpreter/plan_machine.h"
#include "compiler/interpreter/unit_arguments.h"

namespace parallax::compiler {

PlanMachine::Step PlanMachine::make_function(PlanState& state, const PlanInstruction& instruction) {
  const auto& made = code_.functions_made[instruction.a];
  const auto variable = [&](const FramePlace& at) {
    return place(state, {PlanOp::kLoad, at.level, at.index, instruction.source});
  };
  Value value;
  value.kind = ValueKind::kFunction;
  value.text =
      made.builtin ? std::string(plan_builtins()[made.unit].name) : code_.units[made.unit].name;
  value.function = {made.unit, made.builtin, 0, 0};
  if (made.level) value.function.link = linked(state, *made.level) + 1;
  for (const auto& at : made.shared) {
    const auto reach = static_cast<std::uint32_t>(variable(at)) + 1;
    value.function.reach = std::max(value.function.reach, reach);
  }
  std::vector<ValueId> kept;
  for (const auto& at : made.kept) kept.push_back(values_.primary(state.stack[variable(at)]));
  value.head = values_.list(kept);
  state.stack.push_back(values_.intern(std::move(value)));
  return {};
}

bool PlanMachine::outlives(ValueId value, std::size_t frame, std::size_t place) const {
  const auto& life = values_[value].function;
  return life.link > frame + 1 || life.reach > place;
}

/// The value on top is about to be kept further down, or to leave its frame.
PlanMachine::Step PlanMachine::check_life(const PlanState& state,
                                          const PlanInstruction& instruction) {
  const auto value = state.stack.back();
  const auto& life = values_[value].function;
  if (life.link == 0 && life.reach == 0) return {};
  const auto top = state.frames.size() - 1;
  std::size_t frame = top;
  std::size_t to = 0;
  if (instruction.op == PlanOp::kStore) {
    frame = linked(state, instruction.a);
    to = place(state, instruction);
  } else if (instruction.op == PlanOp::kStoreSpecial) {
    const auto guard = std::find_if(state.guards.rbegin(), state.guards.rend(), [&](auto& g) {
      return g.kind == GuardKind::kSpecial && g.index == instruction.a;
    });
    frame = guard->frame;
    to = guard->height;
  } else if (instruction.op == PlanOp::kSqueeze) {
    to = state.stack.size() - 1 - instruction.a;
  } else if (instruction.op == PlanOp::kExit) {
    frame = linked(state, instruction.a);
    to = state.frames[frame].base + std::size_t{code_.exits[instruction.b].height};
  } else if (instruction.op == PlanOp::kReturn && top > 0) {
    frame = top - 1;
    to = state.frames[top].base - code_.units[state.frames[top].unit].kept;
  } else {
    frame = 0;
  }
  if (!outlives(value, frame, to)) return {};
  return error(codes::kUnsupportedPlanForm, instruction,
               "a function outlives what it shares with the code around it: variables that change, "
               "local functions or blocks; keep it inside, or let it use variables that nothing "
               "changes");
}

PlanMachine::Step PlanMachine::call_value(PlanState& state, const PlanInstruction& instruction) {
  auto& stack = state.stack;
  const auto first = stack.end() - static_cast<std::ptrdiff_t>(instruction.a);
  std::vector<ValueId> arguments(first, stack.end());
  const auto callee = *(first - 1);
  if (instruction.b != 0) {
    const auto last = arguments.back();
    const auto spread = values_.elements(last);
    if (!spread && values_.kind(last) == ValueKind::kModel) {
      report(codes::kModelList, instruction.source, "apply");
      return StopError{};
    }
    if (!spread) {
      return error(codes::kPlanValue, instruction,
                   fmt::format("expected a list, not {}", values_.print(last)));
    }
    arguments.pop_back();
    arguments.insert(arguments.end(), spread->begin(), spread->end());
  }
  auto function = values_[callee].function;
  auto kept = values_[callee].head;
  const auto& value = values_[callee];
  if (value.kind == ValueKind::kSymbol && !value.keyword) {
    const auto named = code_.functions.find(value.key.empty() ? value.text : value.key);
    const auto known = find_builtin(value.text);
    if (named == code_.functions.end() && !known) {
      report(codes::kUnknownPlanForm, instruction.source, value.text);
      return StopError{};
    }
    const bool builtin = named == code_.functions.end();
    function = {builtin ? *known : named->second, builtin, 0, 0};
    kept = values_.nil();
  } else if (value.kind != ValueKind::kFunction) {
    return error(codes::kPlanValue, instruction,
                 fmt::format("{} is called, which is no function", values_.print(callee)));
  }
  if (!function.builtin && !code_.units[function.unit].ready) return StopUnit{function.unit};
  stack.resize(stack.size() - instruction.a - 1);
  return enter_value(state, std::move(arguments), function, kept, instruction);
}

namespace {

std::string count_text(std::size_t count) { return base::counted(count, "argument"); }

}  // namespace

PlanMachine::Step PlanMachine::enter_value(PlanState& state, std::vector<ValueId> arguments,
                                           const PlanFunctionValue& function, ValueId kept,
                                           const PlanInstruction& instruction) {
  const auto wrong = [&](std::string_view name, const std::string& text) {
    report(codes::kPlanArguments, instruction.source, name, text);
    return StopError{};
  };
  if (function.builtin) {
    const auto& known = plan_builtins()[function.unit];
    const auto count = static_cast<std::uint32_t>(arguments.size());
    if (count < known.min_arguments || count > known.max_arguments) {
      return wrong(known.name, fmt::format("it is called with {}", count_text(arguments.size())));
    }
    state.stack.insert(state.stack.end(), arguments.begin(), arguments.end());
    return builtin(state, {PlanOp::kBuiltin, function.unit, count, instruction.source});
  }
  const auto& unit = code_.units[function.unit];
  if (unit.top_level) {
    return wrong(unit.name, "a `def-top-level-cram-function` cannot be called from a plan");
  }
  const auto sorted = unit_arguments(unit, arguments, values_);
  if (const auto* text = std::get_if<std::string>(&sorted)) return wrong(unit.name, *text);
  const auto& bound = std::get<0>(sorted);
  auto below = values_.elements(kept).value_or(std::vector<ValueId>());
  state.stack.insert(state.stack.end(), below.rbegin(), below.rend());
  state.stack.insert(state.stack.end(), bound.begin(), bound.end());
  const auto link = function.link == 0 ? 0 : function.link - 1;
  return enter_unit(state, function.unit, link, instruction.source);
}

/// Only what hands a value on may see all of several values.
void PlanMachine::take_primary(PlanState& state, const PlanInstruction& instruction) {
  auto& stack = state.stack;
  std::size_t count = 0;
  switch (instruction.op) {
    case PlanOp::kBuiltin:
      count = instruction.b;
      break;
    case PlanOp::kCall:
    case PlanOp::kCallLocal:
      count = code_.units[instruction.a].parameters;
      break;
    case PlanOp::kCallValue:
      count = std::size_t{instruction.a} + 1;
      break;
    case PlanOp::kValues:
      count = instruction.a;
      break;
    case PlanOp::kLoad: {
      auto& variable = stack[place(state, instruction)];
      variable = values_.primary(variable);
      return;
    }
    case PlanOp::kStore:
    case PlanOp::kStoreGlobal:
    case PlanOp::kStoreSpecial:
    case PlanOp::kJumpIfNil:
    case PlanOp::kHolds:
    case PlanOp::kAddKey:
    case PlanOp::kPerform:
    case PlanOp::kFailValue:
    case PlanOp::kExpectList:
    case PlanOp::kSpreadValues:
    case PlanOp::kStamp:
    case PlanOp::kWait:
      count = 1;
      break;
    case PlanOp::kConstant:
    case PlanOp::kLoadGlobal:
    case PlanOp::kBindSpecial:
    case PlanOp::kPop:
    case PlanOp::kSqueeze:
    case PlanOp::kJump:
    case PlanOp::kDesignator:
    case PlanOp::kFunction:
    case PlanOp::kListValues:
    case PlanOp::kUnpack:
    case PlanOp::kReturn:
    case PlanOp::kPushHandlers:
    case PlanOp::kPushCleanup:
    case PlanOp::kPushTask:
    case PlanOp::kPopGuard:
    case PlanOp::kRunCleanup:
    case PlanOp::kEndHandler:
    case PlanOp::kEndCleanup:
    case PlanOp::kExit:
    case PlanOp::kFail:
    case PlanOp::kPar:
    case PlanOp::kEndBranch:
    case PlanOp::kSleep:
    case PlanOp::kTick:
    case PlanOp::kDone:
      return;
  }
  for (auto i = stack.size() - count; i < stack.size(); ++i) stack[i] = values_.primary(stack[i]);
}

void PlanMachine::multiple_values(PlanState& state, const PlanInstruction& instruction) {
  auto& stack = state.stack;
  const auto all_of = [&](ValueId value) {
    if (values_.kind(value) != ValueKind::kValues) return std::vector<ValueId>{value};
    return *values_.elements(values_[value].head);
  };
  if (instruction.op == PlanOp::kValues) {
    const std::vector<ValueId> all(stack.end() - static_cast<std::ptrdiff_t>(instruction.a),
                                   stack.end());
    stack.resize(stack.size() - instruction.a);
    stack.push_back(values_.multiple(all));
    return;
  }
  const auto top = stack.back();
  stack.pop_back();
  if (instruction.op == PlanOp::kSpreadValues) {
    stack.push_back(values_.multiple(values_.elements(top).value_or(std::vector<ValueId>())));
  } else if (instruction.op == PlanOp::kListValues) {
    stack.push_back(values_.list(all_of(top)));
  } else {
    auto all = all_of(top);
    all.resize(instruction.a, values_.nil());
    stack.insert(stack.end(), all.begin(), all.end());
  }
}

/// The list on top was made at that place of a macro's text.
void PlanMachine::stamp(PlanState& state, const PlanInstruction& instruction) {
  Value value = values_[state.stack.back()];
  if (value.kind != ValueKind::kCons || value.origin.list != 0) return;
  value.origin = {instruction.a + 1, kWholeTemplate, true};
  value.registers.clear();
  state.stack.back() = values_.intern(std::move(value));
}

}  // namespace parallax::compiler
