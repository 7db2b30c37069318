// Runs a compiled plan on a stack machine until something has to be decided outside of it.
//
// A state has frames, guards, a stack of values, the branches of `par` and the links of
// designators, all of them plain numbers that name code and stored values. So a state is copied
// as it is, and its key is a list of numbers by which explored states are compared; counters of
// loops can be left out of the key. The machine stops at a perform, a question to the model, a
// proof, a failure that nothing handles, a bound or the end. Whoever explores the plan decides
// and goes on, with one copy of the state for each answer.
//
// A unit that is entered again more often than the limit ends in a bound if something was
// performed since its outermost call, else it is an endless recursion and an error. Loops count
// their iterations against a bound. Cost: steps, values and text are limited.

#include "compiler/interpreter/plan_machine.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "compiler/base/codes/plans.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

class KeyWriter {
 public:
  KeyWriter(const ValueStore& values, bool counters) : values_(values), counters_(counters) {}

  void part(const std::vector<PlanFrame>& frames, const std::vector<PlanGuard>& guards,
            const std::vector<ValueId>& stack) {
    number(frames.size());
    number(guards.size());
    number(stack.size());
    for (const auto& frame : frames) {
      const std::uint32_t kinds = static_cast<std::uint32_t>(frame.kind) * 8U +
                                  static_cast<std::uint32_t>(frame.pending.kind);
      key.insert(key.end(), {frame.unit, frame.pc, frame.link, frame.base, frame.guard_base, kinds,
                             frame.skip_to, frame.clause, frame.failure.index(),
                             frame.pending.frame, frame.pending.exit, frame.pending.value.index()});
    }
    for (const auto& guard : guards) {
      key.insert(key.end(),
                 {static_cast<std::uint32_t>(guard.kind), guard.index, guard.frame, guard.height});
    }
    for (const auto value : stack) {
      const bool hidden = !counters_ && values_.kind(value) == ValueKind::kCounter;
      key.push_back(hidden ? std::numeric_limits<std::uint32_t>::max() : value.index());
    }
  }

  void links(const DesignatorLinks& links) {
    for (const auto& chain : links.chains) {
      number(chain.size());
      for (const auto member : chain) number(member.index());
    }
    for (const auto* entries : {&links.heap.cells, &links.heap.globals}) {
      if (!entries->empty()) number(entries->size());
      for (const auto& [key_of_it, value] : *entries) {
        number(key_of_it);
        number(value.index());
      }
    }
  }

  void sleep(std::uint32_t slept, std::uint32_t asleep) { key.insert(key.end(), {slept, asleep}); }

  /// As deep as the text nests `par`.
  void pars(const std::vector<PlanPar>& pars) {
    number(pars.size());
    for (const auto& par : pars) {
      number(par.frames);
      number(par.active);
      number(par.form.index());
      number(par.failure ? par.failure->index() + 1 : 0);
      number(par.value ? par.value->index() + 1 : 0);
      for (const auto& branch : par.branches) {
        const auto asks = branch.turn ? static_cast<std::uint32_t>(branch.turn->asks) : 0U;
        number((branch.started ? 1U : 0U) + (branch.done ? 2U : 0U) + (branch.turn ? 4U : 0U) +
               (branch.fresh ? 8U : 0U) + (branch.asks ? 16U : 0U) + (branch.awake ? 32U : 0U) +
               64U * asks);
        number(branch.result.index());
        if (branch.turn) number(branch.turn->designator.index());
        part(branch.frames, branch.guards, branch.stack);
        this->pars(branch.pars);
      }
    }
  }

  std::vector<std::uint32_t> key;

 private:
  void number(std::size_t value) { key.push_back(static_cast<std::uint32_t>(value)); }
  const ValueStore& values_;
  bool counters_;
};

void visit_part(const std::vector<PlanFrame>& frames, const std::vector<ValueId>& stack,
                const std::function<void(ValueId)>& visit) {
  for (const auto value : stack) visit(value);
  for (const auto& frame : frames) {
    visit(frame.pending.value);
    visit(frame.failure);
  }
}

void visit_pars(const std::vector<PlanPar>& pars, const std::function<void(ValueId)>& visit) {
  for (const auto& par : pars) {
    if (par.failure) visit(*par.failure);
    if (par.value) visit(*par.value);
    for (const auto& branch : par.branches) {
      visit(branch.result);
      if (branch.turn) visit(branch.turn->designator);
      visit_part(branch.frames, branch.stack, visit);
      visit_pars(branch.pars, visit);
    }
  }
}

ValueId pop(PlanState& state) {
  const auto value = state.stack.back();
  state.stack.pop_back();
  return value;
}

}  // namespace

void for_each_value(const PlanState& state, const std::function<void(ValueId)>& visit) {
  visit_part(state.frames, state.stack, visit);
  visit_pars(state.pars, visit);
  for (const auto& chain : state.links.chains) {
    for (const auto member : chain) visit(member);
  }
  for (const auto& [cell, content] : state.links.heap.cells) visit(content);
  for (const auto& [global, value] : state.links.heap.globals) visit(value);
}

std::vector<std::uint32_t> state_key(const PlanState& state, const ValueStore& values,
                                     bool counters) {
  KeyWriter writer(values, counters);
  writer.part(state.frames, state.guards, state.stack);
  if (!state.pars.empty()) writer.pars(state.pars);
  writer.links(state.links);
  if (counters && state.slept > 0) writer.sleep(state.slept, state.asleep);
  return std::move(writer.key);
}

std::string PlanMachine::name_at(DatumId form) const {
  if (const auto head = data_.head(form)) return std::string(*head);
  return data_.is_list(form) ? std::string("(...)") : print_datum(data_, form);
}

StopError PlanMachine::error(DiagnosticCode code, const PlanInstruction& at, std::string text) {
  report(code, at.source, name_at(place_of(at.source)), text);
  return {};
}

PlanState PlanMachine::start(std::uint32_t unit, const std::vector<ValueId>& arguments) const {
  PlanState state;
  state.frames.push_back({});
  state.frames.back().unit = unit;
  state.stack = arguments;
  return state;
}

PlanState PlanMachine::start() const {
  PlanState state;
  state.frames.push_back({});
  state.frames.back().unit = code_.main;
  state.links.heap = first_heap_;
  if (first_heap_.kept > 0) state.links.next = first_heap_.kept + 1;
  return state;
}

bool PlanMachine::run_definitions() {
  globals_.assign(code_.globals.size(), std::nullopt);
  PlanState state = start();
  state.frames.back().unit = code_.definitions;
  const auto stop = run(state);
  if (const auto* perform = std::get_if<StopPerform>(&stop)) {
    sink_.error(codes::kUnsupportedPlanForm, data_.source(perform->form), "perform",
                "the value of a global constant cannot perform");
  } else if (const auto* question = std::get_if<StopQuestion>(&stop)) {
    sink_.error(codes::kUnsupportedPlanForm, data_.source(question->form), name_at(question->form),
                "the value of a global constant cannot ask the model");
  } else if (const auto* failed = std::get_if<StopFailed>(&stop)) {
    sink_.error(
        codes::kUnsupportedPlanForm, data_.source(code_.globals[0].source), "fail",
        fmt::format("the value of a global constant fails with `{}`", failed->failure_class));
  } else if (const auto* bound = std::get_if<StopBound>(&stop)) {
    sink_.error(codes::kUnsupportedPlanForm, data_.source(bound->at), bound->form,
                "the loop does not end, in the value of a global constant");
  }
  first_heap_ = state.links.heap;
  for (const auto& [cell, content] : first_heap_.cells) first_heap_.kept = cell;
  return std::holds_alternative<StopDone>(stop);
}

void PlanMachine::report_full(DatumId at) {
  const auto code = blame_ ? codes::kMacroLimit : codes::kUnrollLimit;
  if (stopped()) {
    sink_.error(codes::kUnrollStopped, data_.source(at));
  } else if (values_.too_much_text()) {
    report(code, at, static_cast<std::int64_t>(kMaxPlanText), "characters of text");
  } else if (values_.full()) {
    report(code, at, static_cast<std::int64_t>(kMaxPlanValues), "values");
  } else {
    report(code, at, limits_.max_steps, "steps");
  }
}

PlanStop PlanMachine::run(PlanState& state) {
  running_ = &state;
  for (;;) {
    auto& frame = state.frames.back();
    const auto& instruction = code_.units[frame.unit].code[frame.pc];
    if (!count_step()) {
      report_full(instruction.source);
      return StopError{};
    }
    ++frame.pc;
    auto stop = execute(state, instruction);
    if (!stop) continue;
    if (std::holds_alternative<StopUnit>(*stop)) --state.frames.back().pc;
    running_ = nullptr;
    return *std::move(stop);
  }
}

std::uint32_t PlanMachine::linked(const PlanState& state, std::uint32_t level) const {
  auto frame = static_cast<std::uint32_t>(state.frames.size() - 1);
  while (level-- > 0) frame = state.frames[frame].link;
  return frame;
}

std::size_t PlanMachine::place(const PlanState& state, const PlanInstruction& instruction) const {
  // Values captured by a function value lie below its frame: the index is negative.
  const auto index = static_cast<std::ptrdiff_t>(static_cast<std::int32_t>(instruction.b));
  const auto base = static_cast<std::ptrdiff_t>(state.frames[linked(state, instruction.a)].base);
  return static_cast<std::size_t>(base + index);
}

PlanMachine::Step PlanMachine::execute(PlanState& state, const PlanInstruction& instruction) {
  auto& stack = state.stack;
  if (code_.multiple_values) take_primary(state, instruction);
  switch (instruction.op) {
    case PlanOp::kConstant:
      stack.push_back(ValueId(instruction.a));
      return {};
    case PlanOp::kLoad:
      stack.push_back(stack[place(state, instruction)]);
      return {};
    case PlanOp::kStore:
      if (auto stop = check_life(state, instruction)) return stop;
      stack[place(state, instruction)] = stack.back();
      return {};
    case PlanOp::kLoadGlobal:
      return load_global(state, instruction);
    case PlanOp::kBindSpecial:
      return bind_special(state, instruction);
    case PlanOp::kStoreSpecial:
      if (auto stop = check_life(state, instruction)) return stop;
      return store_special(state, instruction);
    case PlanOp::kStoreGlobal:
      if (auto stop = check_life(state, instruction)) return stop;
      globals_[instruction.a] = pop(state);
      return {};
    case PlanOp::kPop:
      stack.pop_back();
      return {};
    case PlanOp::kSqueeze:
      if (auto stop = check_life(state, instruction)) return stop;
      stack.erase(stack.end() - 1 - static_cast<std::ptrdiff_t>(instruction.a), stack.end() - 1);
      return {};
    case PlanOp::kJump:
      state.frames.back().pc = instruction.a;
      return {};
    case PlanOp::kJumpIfNil:
      if (values_.is_nil(pop(state))) state.frames.back().pc = instruction.a;
      return {};
    case PlanOp::kBuiltin:
      return builtin(state, instruction);
    case PlanOp::kHolds:
      if (instruction.a == 0) return StopQuestion{pop(state), instruction.source};
      return StopProof{pop(state), instruction.source, instruction.a == 2};
    case PlanOp::kDesignator:
      refresh_links(state, {});
      stack.push_back(state.links.make(values_, static_cast<DesignatorKind>(instruction.a), {}));
      return {};
    case PlanOp::kAddKey:
      add_key(state, instruction);
      return {};
    case PlanOp::kPerform:
      return StopPerform{pop(state), instruction.source};
    case PlanOp::kExpectList:
      return expect_list(state, instruction);
    case PlanOp::kCall:
    case PlanOp::kCallLocal:
      return call(state, instruction);
    case PlanOp::kFunction:
      return make_function(state, instruction);
    case PlanOp::kCallValue:
      return call_value(state, instruction);
    case PlanOp::kValues:
    case PlanOp::kSpreadValues:
    case PlanOp::kListValues:
    case PlanOp::kUnpack:
      multiple_values(state, instruction);
      return {};
    case PlanOp::kStamp:
      stamp(state, instruction);
      return {};
    case PlanOp::kReturn:
      if (auto stop = check_life(state, instruction)) return stop;
      return leave(state);
    case PlanOp::kExit: {
      if (auto stop = check_life(state, instruction)) return stop;
      const auto carried = pop(state);
      const auto frame = linked(state, instruction.a);
      if (auto stop = check_exit(state, instruction, frame)) return stop;
      return jump_out(state, {PendingKind::kExit, frame, instruction.b, carried});
    }
    case PlanOp::kPar:
      return start_par(state, instruction);
    case PlanOp::kEndBranch:
      if (auto stop = check_life(state, instruction)) return stop;
      return end_branch(state);
    case PlanOp::kSleep:
      stack.push_back(values_.nil());
      if (state.pars.empty()) return {};
      return sleep(state, instruction.source);
    case PlanOp::kWait:
      return wait_for(state, instruction);
    case PlanOp::kTick:
      return tick(state, instruction);
    case PlanOp::kDone:
      return StopDone{};
    case PlanOp::kPushHandlers:
    case PlanOp::kPushCleanup:
    case PlanOp::kPushTask:
      push_guard(state, instruction);
      return {};
    case PlanOp::kPopGuard:
      state.guards.pop_back();
      return {};
    case PlanOp::kRunCleanup:
      run_cleanup(state, instruction);
      return {};
    case PlanOp::kEndHandler:
      return end_handler(state);
    case PlanOp::kEndCleanup:
      return end_cleanup(state);
    case PlanOp::kFail:
      return raise(state, values_.failure(code_.strings[instruction.a]));
    case PlanOp::kFailValue:
      return fail_value(state, instruction);
  }
  return StopError{};
}

/// A local function may be called in another task than the one whose block it leaves.
PlanMachine::Step PlanMachine::check_exit(const PlanState& state,
                                          const PlanInstruction& instruction, std::uint32_t frame) {
  const auto left = state.frames[frame].guard_base + code_.exits[instruction.b].guards;
  for (auto guard = std::size_t{left}; guard < state.guards.size(); ++guard) {
    if (state.guards[guard].kind != GuardKind::kTask) continue;
    sink_
        .error(codes::kReturnOutsideBlock, data_.source(instruction.source),
               name_at(instruction.source))
        .note(
            "it is reached in a task of its own, a `def-cram-function` or a branch of `par`, which "
            "nothing leaves but its end and a failure");
    return StopError{};
  }
  return {};
}

PlanMachine::Step PlanMachine::expect_list(const PlanState& state,
                                           const PlanInstruction& instruction) {
  const auto top = state.stack.back();
  if (values_.kind(top) == ValueKind::kModel) {
    report(codes::kModelList, instruction.source, name_at(place_of(instruction.source)));
    return StopError{};
  }
  if (values_.elements(top)) return {};
  return error(codes::kPlanValue, instruction,
               fmt::format("expected a list, not {}", values_.print(top)));
}

void PlanMachine::add_key(PlanState& state, const PlanInstruction& instruction) {
  const auto item = pop(state);
  Value value = values_[state.stack.back()];
  value.keys.emplace_back(code_.strings[instruction.a], item);
  state.stack.back() = values_.intern(std::move(value));
}

PlanMachine::Step PlanMachine::builtin(PlanState& state, const PlanInstruction& instruction) {
  const auto count = static_cast<std::ptrdiff_t>(instruction.b);
  const std::vector<ValueId> arguments(state.stack.end() - count, state.stack.end());
  state.stack.resize(state.stack.size() - arguments.size());
  refresh_links(state, arguments);
  auto result = call_builtin(instruction.a, arguments, code_.classes, limits_.location_samples,
                             state.links, values_);
  note_doubt(instruction.source);
  if (const auto* value = std::get_if<ValueId>(&result)) {
    state.stack.push_back(*value);
    return {};
  }
  if (const auto* equality = std::get_if<ModelEquality>(&result)) {
    return StopQuestion{*equality, place_of(instruction.source)};
  }
  const auto& failure = std::get<BuiltinFailure>(result);
  if (failure.kind == BuiltinError::kRaise) return raise(state, values_.failure(failure.text));
  report(failure, instruction.a, instruction.source);
  return StopError{};
}

/// Counts an iteration of a loop that nothing static ends.
PlanMachine::Step PlanMachine::tick(PlanState& state, const PlanInstruction& instruction) {
  auto& counter = state.stack[state.frames.back().base + std::size_t{instruction.a}];
  const auto count = values_[counter].number.numerator() + 1;
  if (count > limits_.max_loop) return StopBound{name_at(instruction.source), instruction.source};
  counter = values_.counter(count);
  return {};
}

/// The end of a unit: its result replaces its variables.
PlanMachine::Step PlanMachine::leave(PlanState& state) {
  const auto result = state.stack.back();
  const auto base = state.frames.back().base - code_.units[state.frames.back().unit].kept;
  state.frames.pop_back();
  // The task of a perform ends with the function that carries it out.
  if (!state.guards.empty() && state.guards.back().kind == GuardKind::kTask &&
      state.guards.back().index == kPerformTask &&
      std::size_t{state.guards.back().frame} + 1 == state.frames.size()) {
    state.guards.pop_back();
  }
  state.stack.resize(base);
  state.stack.push_back(result);
  return {};
}

PlanMachine::Step PlanMachine::call(PlanState& state, const PlanInstruction& instruction) {
  const bool local = instruction.op == PlanOp::kCallLocal;
  return enter_unit(state, instruction.a, local ? linked(state, instruction.b) : 0,
                    instruction.source);
}

/// The arguments are on the stack.
PlanMachine::Step PlanMachine::enter_unit(PlanState& state, std::uint32_t index, std::uint32_t link,
                                          DatumId form) {
  const auto& unit = code_.units[index];
  if (!unit.ready) return StopUnit{index};
  std::uint32_t depth = 0;
  const PlanFrame* outermost = nullptr;
  // Frames between a handler and the frame it belongs to have failed and are no longer active.
  for (auto f = static_cast<std::uint32_t>(state.frames.size()); f-- > 0;) {
    const auto& active = state.frames[f];
    if (active.unit == index) {
      outermost = &active;
      ++depth;
    }
    if (active.kind == FrameKind::kHandler) f = active.link + 1;
  }
  // Our own Lisp recurses over data of the plan, and ends.
  if (outermost != nullptr && depth >= limits_.max_call_depth && !data_.in_library(unit.source)) {
    if (outermost->performs != state.performs) return StopBound{unit.name, place_of(form)};
    report(codes::kPlanRecursion, form, unit.name, limits_.max_call_depth);
    return StopError{};
  }
  PlanFrame frame;
  frame.unit = index;
  frame.link = link;
  frame.base = static_cast<std::uint32_t>(state.stack.size()) - unit.parameters;
  frame.guard_base = static_cast<std::uint32_t>(state.guards.size());
  frame.performs = state.performs;
  state.frames.push_back(frame);
  return {};
}

std::optional<PlanStop> PlanMachine::enter(PlanState& state, std::uint32_t unit,
                                           const std::vector<ValueId>& arguments, DatumId form) {
  const auto caller = static_cast<std::uint32_t>(state.frames.size() - 1);
  const auto height = static_cast<std::uint32_t>(state.stack.size());
  state.guards.push_back({GuardKind::kTask, kPerformTask, caller, height});
  state.stack.insert(state.stack.end(), arguments.begin(), arguments.end());
  return enter_unit(state, unit, 0, form);
}

}  // namespace parallax::compiler
