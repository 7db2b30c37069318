// Where values go in the code of the stack machine. The value is not known, only where it lies: an
// abstract state is an instruction and the place of the value on the frame's stack. Every
// instruction moves, copies, drops or uses what lies at that place, so the states that one value
// reaches are found by a search through the instructions. It stays within a unit, but for results,
// which go to all calls of the unit, and for exits, which know the unit that they lead to. What
// units within the unit read (handlers, clean-ups, branches, local functions) counts as used where
// they are linked to the frame. Heights of the stack are known without running: the compiler gives
// each instruction one height. A search costs at most one step for each instruction and place.
#include "compiler/interpreter/value_flow.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <string_view>

#include "compiler/builtins/plan_builtins.h"

namespace parallax::compiler {
namespace {

constexpr std::uint32_t kNoHeight = std::numeric_limits<std::uint32_t>::max();

/// By how much the instruction changes the height of the stack.
std::int64_t change_of(const PlanCode& code, const PlanInstruction& instruction) {
  const std::int64_t a = instruction.a;
  switch (instruction.op) {
    case PlanOp::kConstant:
    case PlanOp::kLoad:
    case PlanOp::kLoadGlobal:
    case PlanOp::kDesignator:
    case PlanOp::kFunction:
    case PlanOp::kFail:
    case PlanOp::kPar:
    case PlanOp::kSleep:
      return 1;
    case PlanOp::kStoreGlobal:
    case PlanOp::kPop:
    case PlanOp::kJumpIfNil:
    case PlanOp::kAddKey:
      return -1;
    case PlanOp::kSqueeze:
    case PlanOp::kCallValue:
      return -a;
    case PlanOp::kBuiltin:
      return 1 - std::int64_t{instruction.b};
    case PlanOp::kCall:
    case PlanOp::kCallLocal:
      return 1 - std::int64_t{code.units[instruction.a].parameters};
    case PlanOp::kValues:
      return 1 - a;
    case PlanOp::kUnpack:
      return a - 1;
    case PlanOp::kStore:
    case PlanOp::kStoreSpecial:
    case PlanOp::kBindSpecial:
    case PlanOp::kJump:
    case PlanOp::kHolds:
    case PlanOp::kPerform:
    case PlanOp::kSpreadValues:
    case PlanOp::kListValues:
    case PlanOp::kStamp:
    case PlanOp::kReturn:
    case PlanOp::kPushHandlers:
    case PlanOp::kPushCleanup:
    case PlanOp::kPushTask:
    case PlanOp::kPopGuard:
    case PlanOp::kRunCleanup:
    case PlanOp::kEndHandler:
    case PlanOp::kEndCleanup:
    case PlanOp::kExit:
    case PlanOp::kFailValue:
    case PlanOp::kExpectList:
    case PlanOp::kEndBranch:
    case PlanOp::kWait:
    case PlanOp::kTick:
    case PlanOp::kDone:
      return 0;
  }
  return 0;
}

/// Built-ins that make a value of their arguments and look at none of them.
bool keeps_arguments(std::string_view builtin) {
  static constexpr std::string_view kNames[] = {
      "list",     "list*",     "cons",    "append",           "acons",
      "identity", "copy-list", "reverse", "%append-reversed", "nreverse"};
  return std::find(std::begin(kNames), std::end(kNames), builtin) != std::end(kNames);
}

}  // namespace

ValueFlow::ValueFlow(const PlanCode& code)
    : code_(code),
      heights_(code.units.size()),
      labels_(code.units.size()),
      captured_(code.units.size()),
      from_inside_(code.units.size()),
      callers_(code.units.size()),
      branch_starts_(code.units.size()),
      unknown_callers_(code.units.size()),
      performed_(code.units.size()) {
  for (const auto& builtin : plan_builtins()) keeping_.push_back(keeps_arguments(builtin.name));
  for (std::uint32_t unit = 0; unit < code.units.size(); ++unit) {
    heights_[unit].assign(code.units[unit].code.size() + 1, kNoHeight);
    labels_[unit].assign(code.units[unit].code.size() + 1, false);
  }
  for (const auto& exit : code.exits) {
    heights_[exit.unit][exit.pc] = exit.height + 1;
    labels_[exit.unit][exit.pc] = true;
  }
  for (std::uint32_t unit = 0; unit < code.units.size(); ++unit) {
    find_heights(unit);
    note_links(unit);
  }
}

void ValueFlow::find_heights(std::uint32_t unit) {
  auto& heights = heights_[unit];
  const auto& code = code_.units[unit].code;
  std::int64_t height = code_.units[unit].parameters;
  for (std::size_t pc = 0; pc < code.size(); ++pc) {
    if (heights[pc] != kNoHeight) height = heights[pc];
    heights[pc] = static_cast<std::uint32_t>(height);
    height += change_of(code_, code[pc]);
    if (code[pc].op != PlanOp::kJump && code[pc].op != PlanOp::kJumpIfNil) continue;
    labels_[unit][code[pc].a] = true;
    auto& target = heights[code[pc].a];
    if (target == kNoHeight) target = static_cast<std::uint32_t>(height);
  }
}

/// Notes how the unit is tied to others: calls, exits, what it reads of the units around it.
void ValueFlow::note_links(std::uint32_t unit) {
  const auto& code = code_.units[unit].code;
  for (std::uint32_t pc = 0; pc < code.size(); ++pc) {
    const auto& one = code[pc];
    if (one.op == PlanOp::kCall || one.op == PlanOp::kCallLocal) {
      callers_[one.a].push_back({unit, pc});
    } else if (one.op == PlanOp::kPerform) {
      performs_.push_back({unit, pc});
    } else if (one.op == PlanOp::kLoad && one.a > 0) {
      note_captured(unit, one.a, one.b);
    } else if (one.op == PlanOp::kBindSpecial) {
      captured_[unit].insert(one.b);
    } else if (one.op == PlanOp::kExit && one.a > 0) {
      from_inside_[code_.exits[one.b].unit].push_back(one.b);
    } else if (one.op == PlanOp::kPar) {
      for (const auto branch : code_.pars[one.a].units) branch_starts_[branch] = {unit, pc};
    } else if (one.op == PlanOp::kFunction && !code_.functions_made[one.a].builtin) {
      const auto& made = code_.functions_made[one.a];
      unknown_callers_[made.unit] = true;
      for (const auto& variable : made.kept) note_captured(unit, variable.level, variable.index);
      for (const auto& variable : made.shared) note_captured(unit, variable.level, variable.index);
    }
  }
}

void ValueFlow::note_captured(std::uint32_t unit, std::uint32_t level, std::uint32_t index) {
  for (; level > 0; --level) {
    const auto around = code_.units[unit].around;
    if (!around) return;
    unit = *around;
  }
  captured_[unit].insert(index);
}

/// Units that only call each other are left out: who would call them is not known.
void ValueFlow::find_reached() {
  const auto count = static_cast<std::uint32_t>(code_.units.size());
  std::vector<std::vector<std::uint32_t>> leads_to(count);
  std::vector<std::uint32_t> open = {code_.main, code_.definitions};
  for (std::uint32_t unit = 0; unit < count; ++unit) {
    for (const auto& site : callers_[unit]) leads_to[site.unit].push_back(unit);
    if (!callers_[unit].empty() && !unknown_callers_[unit] && !performed_[unit]) continue;
    // Handlers, branches and function values run where the unit around them does.
    const auto around = code_.units[unit].around;
    if (around) {
      leads_to[*around].push_back(unit);
    } else {
      open.push_back(unit);
    }
  }
  reached_.assign(count, false);
  while (!open.empty()) {
    const auto unit = open.back();
    open.pop_back();
    if (reached_[unit]) continue;
    reached_[unit] = true;
    open.insert(open.end(), leads_to[unit].begin(), leads_to[unit].end());
  }
}

const PlanInstruction& ValueFlow::at(const ValuePlace& place) const {
  return code_.units[place.unit].code[place.pc];
}

void ValueFlow::open(std::uint32_t unit, std::uint32_t pc, std::uint32_t slot) {
  // A place above the stack belongs to code that only lies behind.
  if (pc >= code_.units[unit].code.size() || slot >= heights_[unit][pc]) return;
  if (visited_.insert({unit, pc, slot}).second) open_.push_back({unit, pc, slot});
}

void ValueFlow::open_exit(std::uint32_t exit, std::uint32_t slot) {
  open(code_.exits[exit].unit, code_.exits[exit].pc, slot);
}

/// The instruction of the site pushes the value.
void ValueFlow::open_result(const CallSite& site) {
  const auto& code = code_.units[site.unit].code;
  const auto after = std::int64_t{heights_[site.unit][site.pc]} + change_of(code_, code[site.pc]);
  open(site.unit, site.pc + 1, static_cast<std::uint32_t>(after - 1));
}

bool ValueFlow::may_be_used(const ValuePlace& from, std::vector<std::uint32_t>& returned) {
  visited_.clear();
  open_.clear();
  open(from.unit, from.pc, from.slot);
  while (!open_.empty()) {
    if (++steps_ > kMaxSteps) return true;
    const auto place = open_.back();
    open_.pop_back();
    if (step(place, returned)) return true;
  }
  return false;
}

/// The instruction takes the `values` uppermost values; `kept`: its result holds them.
bool ValueFlow::taken(const ValuePlace& place, std::uint32_t values, bool kept) {
  const auto first = height(place.unit, place.pc) - values;
  if (place.slot < first) {
    stay(place);
    return false;
  }
  if (kept) open(place.unit, place.pc + 1, first);
  return !kept;
}

/// Follows the value over one instruction; true: something looks at it.
bool ValueFlow::step(const ValuePlace& place, std::vector<std::uint32_t>& returned) {
  const auto& one = at(place);
  const auto below = height(place.unit, place.pc) - 1;  // the place of the top
  const bool top = place.slot == below;
  switch (one.op) {
    case PlanOp::kConstant:
    case PlanOp::kLoadGlobal:
    case PlanOp::kDesignator:
    case PlanOp::kPushTask:
    case PlanOp::kPopGuard:
    case PlanOp::kRunCleanup:
    case PlanOp::kTick:
    case PlanOp::kSleep:
    case PlanOp::kFail:
    case PlanOp::kSpreadValues:
    case PlanOp::kListValues:
    case PlanOp::kStamp:
    case PlanOp::kExpectList:
      stay(place);
      return false;
    case PlanOp::kLoad:
      if (one.a == 0 && one.b == place.slot) open(place.unit, place.pc + 1, below + 1);
      stay(place);
      return false;
    case PlanOp::kStore:
      return store(place);
    case PlanOp::kBindSpecial:
      stay(place);
      return one.b == place.slot;
    case PlanOp::kPop:
      if (!top) stay(place);
      return false;
    case PlanOp::kSqueeze:
      if (top) open(place.unit, place.pc + 1, place.slot - one.a);
      if (place.slot < below - one.a) stay(place);
      return false;
    case PlanOp::kJump:
    case PlanOp::kJumpIfNil:
      return jump(place);
    case PlanOp::kStoreGlobal:
    case PlanOp::kStoreSpecial:
    case PlanOp::kHolds:
    case PlanOp::kAddKey:
    case PlanOp::kPerform:
    case PlanOp::kFailValue:
    case PlanOp::kWait:
      return taken(place, 1, false);
    case PlanOp::kBuiltin:
      return taken(place, one.b, keeping_[one.a]);
    case PlanOp::kCall:
      return taken(place, code_.units[one.a].parameters, false);
    case PlanOp::kCallLocal:
      return shared(place) || taken(place, code_.units[one.a].parameters, false);
    case PlanOp::kCallValue:
      return taken(place, one.a + 1, false);
    case PlanOp::kValues:
      return taken(place, one.a, true);
    case PlanOp::kUnpack:
      if (!top) stay(place);
      for (std::uint32_t i = 0; top && i < one.a; ++i) open(place.unit, place.pc + 1, below + i);
      return false;
    case PlanOp::kFunction:
    case PlanOp::kPushHandlers:
    case PlanOp::kPushCleanup:
    case PlanOp::kPar:
      stay(place);
      return shared(place);
    case PlanOp::kReturn:
      return top && returns(place, returned);
    case PlanOp::kExit:
      return exit(place);
    case PlanOp::kEndBranch:
      return top && end_branch(place);
    case PlanOp::kDone:
      return top && place.unit != code_.main;
    case PlanOp::kEndHandler:
    case PlanOp::kEndCleanup:
      return false;
  }
  return true;
}

bool ValueFlow::jump(const ValuePlace& place) {
  const auto& one = at(place);
  const bool always = one.op == PlanOp::kJump;
  if (!always && place.slot + 1 == height(place.unit, place.pc)) return true;
  open(place.unit, one.a, place.slot);
  // Later branches of a `pursue` stand where nothing leads: what they read is used in the plan.
  if (!always || !labels_[place.unit][place.pc + 1]) stay(place);
  return false;
}

bool ValueFlow::exit(const ValuePlace& place) {
  const auto& one = at(place);
  const auto& target = code_.exits[one.b];
  if (place.slot + 1 == height(place.unit, place.pc)) {
    open_exit(one.b, target.height);
    return false;
  }
  if (one.a == 0 && place.slot < target.height) open_exit(one.b, place.slot);
  if (!labels_[place.unit][place.pc + 1]) stay(place);
  return false;
}

bool ValueFlow::store(const ValuePlace& place) {
  const auto& one = at(place);
  const bool top = place.slot + 1 == height(place.unit, place.pc);
  if (!top) {
    if (one.a != 0 || one.b != place.slot) stay(place);
    return false;
  }
  // A variable that the plan sets may be there for what comes later.
  if (one.a != 0 || code_.units[place.unit].assigned.contains(one.b)) return true;
  const ValuePlace variable{place.unit, place.pc, one.b};
  stay(place);
  stay(variable);
  return shared(variable);
}

/// Units that are linked to the frame may read the place, or leave for exits that keep it.
bool ValueFlow::shared(const ValuePlace& place) {
  if (captured_[place.unit].contains(place.slot)) return true;
  for (const auto exit : from_inside_[place.unit]) {
    if (place.slot < code_.exits[exit].height) open_exit(exit, place.slot);
  }
  return false;
}

bool ValueFlow::returns(const ValuePlace& place, std::vector<std::uint32_t>& returned) {
  const auto unit = place.unit;
  if (reached_.empty()) find_reached();
  const bool called = std::any_of(callers_[unit].begin(), callers_[unit].end(),
                                  [&](const CallSite& site) { return reached_[site.unit]; });
  const bool known = called || performed_[unit];
  if (unknown_callers_[unit] || !known) return true;
  returned.push_back(unit);
  for (const auto& site : callers_[unit]) open_result(site);
  if (!performed_[unit]) return false;
  for (const auto& site : performs_) open_result(site);
  return false;
}

/// The value of a `par` is that of its first branch, of a `pursue` that of any.
bool ValueFlow::end_branch(const ValuePlace& place) {
  const auto& start = branch_starts_[place.unit];
  const auto& par = code_.pars[code_.units[start.unit].code[start.pc].a];
  if (par.exit || par.units.front() == place.unit) open_result(start);
  return false;
}

}  // namespace parallax::compiler
