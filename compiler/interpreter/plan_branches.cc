// `par` and `pursue` whose branches take turns, perform by perform. All branches begin at the same
// height of frames, guards and stack; the one that runs is in place, the others are kept aside.
// Each is a task of its own. When the first of them fails (of a `pursue`: ends), the others may
// still carry out the performs at which they wait; then they run their clean-ups, and the whole
// ends.
#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "compiler/base/codes/plans.h"
#include "compiler/interpreter/plan_machine.h"

namespace parallax::compiler {
namespace {

template <typename T>
std::vector<T> take_above(std::vector<T>& all, std::size_t height) {
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(height);
  std::vector<T> out(std::make_move_iterator(begin), std::make_move_iterator(all.end()));
  all.erase(begin, all.end());
  return out;
}

template <typename T>
void put_back(std::vector<T>& all, std::vector<T>& part) {
  std::move(part.begin(), part.end(), std::back_inserter(all));
  part.clear();
}

/// Puts a branch of the innermost `par` in place.
void put_in_place(PlanState& state, std::size_t branch) {
  auto& par = state.pars.back();
  par.active = branch;
  auto& own = par.branches[branch];
  own.fresh = own.fresh || !own.started;
  own.started = true;
  put_back(state.frames, own.frames);
  put_back(state.guards, own.guards);
  put_back(state.stack, own.stack);
  auto nested = std::move(own.pars);
  own.pars.clear();
  put_back(state.pars, nested);
}

/// Puts the running branch of the `par` at this depth aside, with every `par` inside it.
void put_aside(PlanState& state, std::size_t depth) {
  auto nested = take_above(state.pars, depth + 1);
  auto& par = state.pars[depth];
  auto& own = par.branches[par.active];
  own.fresh = own.awake = false;
  own.pars = std::move(nested);
  own.frames = take_above(state.frames, par.frames);
  own.guards = take_above(state.guards, par.guards);
  own.stack = take_above(state.stack, par.height);
}

bool has_cleanup(const PlanBranchState& branch) {
  const auto cleans_up = [](const PlanGuard& guard) { return guard.kind == GuardKind::kCleanup; };
  if (std::any_of(branch.guards.begin(), branch.guards.end(), cleans_up)) return true;
  for (const auto& par : branch.pars) {
    if (std::any_of(par.branches.begin(), par.branches.end(), has_cleanup)) return true;
  }
  return false;
}

bool runs_cleanup(const PlanFrame& frame) { return frame.kind == FrameKind::kCleanup; }

bool in_cleanup(const PlanBranchState& branch) {
  if (std::any_of(branch.frames.begin(), branch.frames.end(), runs_cleanup)) return true;
  for (const auto& par : branch.pars) {
    if (std::any_of(par.branches.begin(), par.branches.end(), in_cleanup)) return true;
  }
  return false;
}

/// How indices move when part of a state is put elsewhere: those from `frame` and `place` on.
struct Shift {
  std::size_t frame = 0;
  std::size_t frames = 0;  // by so much
  std::size_t place = 0;
  std::size_t places = 0;
};

std::uint32_t moved_frame(std::uint32_t frame, const std::vector<Shift>& shifts) {
  for (auto shift = shifts.rbegin(); shift != shifts.rend(); ++shift) {
    if (frame >= shift->frame) return frame + static_cast<std::uint32_t>(shift->frames);
  }
  return frame;
}

std::uint32_t moved_place(std::uint32_t place, const std::vector<Shift>& shifts) {
  for (auto shift = shifts.rbegin(); shift != shifts.rend(); ++shift) {
    if (place >= shift->place) return place + static_cast<std::uint32_t>(shift->places);
  }
  return place;
}

/// Puts the data that the clean-ups of an ended branch need on top of everything: they run when
/// control leaves the part below.
void keep_cleanups(PlanState& state, const PlanPar& par, const PlanBranchState& branch,
                   std::vector<Shift> shifts) {
  if (!has_cleanup(branch)) return;
  shifts.push_back(
      {par.frames, state.frames.size() - par.frames, par.height, state.stack.size() - par.height});
  const auto border = static_cast<std::uint32_t>(state.guards.size());
  state.guards.push_back({GuardKind::kEvaporated, 0,
                          static_cast<std::uint32_t>(state.frames.size()),
                          static_cast<std::uint32_t>(state.stack.size())});
  for (auto frame : branch.frames) {
    frame.link = moved_frame(frame.link, shifts);
    frame.base = moved_place(frame.base, shifts);
    frame.guard_base = border;
    frame.skip_to = border;
    frame.pc = 0;
    state.frames.push_back(frame);
  }
  state.stack.insert(state.stack.end(), branch.stack.begin(), branch.stack.end());
  for (auto guard : branch.guards) {
    if (guard.kind != GuardKind::kCleanup && guard.kind != GuardKind::kSpecial) continue;
    guard.frame = moved_frame(guard.frame, shifts);
    guard.height = moved_place(guard.height, shifts);
    state.guards.push_back(guard);
  }
  for (const auto& nested : branch.pars) {
    for (auto inner = nested.branches.rbegin(); inner != nested.branches.rend(); ++inner) {
      keep_cleanups(state, nested, *inner, shifts);
    }
  }
}

std::vector<PlanMachine::ParEnd> ends_of(const PlanPar& par) {
  using ParEnd = PlanMachine::ParEnd;
  std::vector<ParEnd> out;
  // Clean-ups that are under way come to their end first.
  if (std::any_of(par.branches.begin(), par.branches.end(), in_cleanup)) return out;
  const bool cleans_up = std::any_of(par.branches.begin(), par.branches.end(), has_cleanup);
  if (par.value) {
    out.push_back(ParEnd::kValue);
    if (cleans_up) out.push_back(ParEnd::kValueWithoutCleanups);
  }
  if (!par.failure) return out;
  out.push_back(ParEnd::kFailure);
  if (!cleans_up) return out;
  out.push_back(ParEnd::kFailureAfterCleanups);
  out.push_back(ParEnd::kFailureWithoutCleanups);
  return out;
}

void find_endings(const PlanPar& par, PlanMachine::BranchPath& path,
                  std::vector<PlanMachine::Ending>& out) {
  for (const auto end : ends_of(par)) out.push_back({path, end});
  for (std::size_t i = 0; i < par.branches.size(); ++i) {
    if (par.branches[i].pars.empty()) continue;
    path.push_back(i);
    find_endings(par.branches[i].pars.front(), path, out);
    path.pop_back();
  }
}

}  // namespace

namespace {

/// Does the branch wait at a perform or a question, not at a `sleep`?
bool resume_performs(const PlanState& state, const PlanMachine::BranchPath& path) {
  const auto* par = &state.pars.front();
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    par = &par->branches[path[i]].pars.front();
  }
  return !par->branches[path.back()].turn->sleeps;
}

}  // namespace

/// A branch that waits for a fluent has a turn while that is not nil.
bool PlanMachine::has_turn(const PlanState& state, const PlanTurn& turn) {
  if (!turn.until) return true;
  const auto value = fluent_value(state, *turn.until);
  const auto* known = std::get_if<ValueId>(&value);
  return known == nullptr || !values_.is_nil(*known);  // an error is reported when it is run
}

void PlanMachine::find_waiting(const PlanState& state, const PlanPar& par, BranchPath& path,
                               std::vector<BranchPath>& out) {
  for (std::size_t i = 0; i < par.branches.size(); ++i) {
    const auto& branch = par.branches[i];
    path.push_back(i);
    if (branch.turn && has_turn(state, *branch.turn)) out.push_back(path);
    if (!branch.pars.empty()) find_waiting(state, branch.pars.front(), path, out);
    path.pop_back();
  }
}

PlanMachine::Step PlanMachine::start_par(PlanState& state, const PlanInstruction& instruction) {
  PlanPar par;
  par.frames = static_cast<std::uint32_t>(state.frames.size());
  par.guards = static_cast<std::uint32_t>(state.guards.size());
  par.height = static_cast<std::uint32_t>(state.stack.size());
  par.form = instruction.source;
  par.exit = code_.pars[instruction.a].exit;
  par.tries = code_.pars[instruction.a].tries;
  for (const auto unit : code_.pars[instruction.a].units) {
    PlanBranchState branch;
    PlanFrame frame;
    frame.unit = unit;
    frame.link = par.frames - 1;
    frame.base = par.height;
    frame.guard_base = par.guards;
    frame.performs = state.performs;
    branch.frames = {frame};
    par.branches.push_back(std::move(branch));
  }
  state.pars.push_back(std::move(par));
  put_in_place(state, 0);
  return {};
}

PlanMachine::Step PlanMachine::end_branch(PlanState& state) {
  auto& par = state.pars.back();
  auto& own = par.branches[par.active];
  own.done = true;
  own.fresh = own.asks = own.awake = false;
  own.result = state.stack.back();
  // A failure that came first decides.
  if (par.exit && !par.failure && !par.value) par.value = own.result;
  state.frames.resize(par.frames);
  state.guards.resize(par.guards);
  state.stack.resize(par.height);
  return next_branch(state);
}

/// The branch that runs has failed, and its clean-ups have run.
PlanMachine::Step PlanMachine::fail_branch(PlanState& state, ValueId failure) {
  auto& par = state.pars.back();
  auto& own = par.branches[par.active];
  own.done = true;
  own.fresh = own.asks = own.awake = false;
  const auto is_done = [](const PlanBranchState& branch) { return branch.done; };
  if (!par.tries) {
    if (!par.failure) par.failure = failure;
  } else if (!par.value && std::all_of(par.branches.begin(), par.branches.end(), is_done)) {
    par.failure = values_.failure("composite-failure");
  }
  state.frames.resize(par.frames);
  state.guards.resize(par.guards);
  state.stack.resize(par.height);
  return next_branch(state);
}

/// No branch of the innermost `par` is in place: starts the next one, or leaves the `par`, or goes
/// outward where all wait.
PlanMachine::Step PlanMachine::next_branch(PlanState& state) {
  for (;;) {
    auto& par = state.pars.back();
    par.active = 0;
    bool all_done = true;
    for (std::size_t i = 0; i < par.branches.size(); ++i) {
      if (!par.branches[i].started) {
        put_in_place(state, i);
        return {};
      }
      all_done = all_done && par.branches[i].done;
    }
    if (par.failure || par.value) {
      std::vector<BranchPath> waiting;
      BranchPath path;
      find_waiting(state, par, path, waiting);
      const auto ends = ends_of(par);
      if (waiting.empty() && ends.size() == 1) return evaporate(state, ends.front());
    } else if (all_done) {
      const auto result = par.branches.front().result;
      state.pars.pop_back();
      state.stack.push_back(result);
      return {};
    }
    if (state.pars.size() == 1) {
      const auto open = waiting(state);
      const bool alone = open.size() == 1 && PlanMachine::endings(state).empty();
      if (!alone || resume_performs(state, open.front())) return StopTurn{};
      resume(state, open.front());  // nobody else has a turn
      return {};
    }
    put_aside(state, state.pars.size() - 2);
  }
}

std::optional<PlanStop> PlanMachine::wait(PlanState& state, const PlanTurn& turn) {
  const auto decided = std::find_if(state.pars.begin(), state.pars.end(), [](const PlanPar& par) {
    return par.failure.has_value() || par.value.has_value();
  });
  // A branch of a decided `par` performs nothing new, except for its first perform and the
  // clean-ups it is in.
  bool goes_on = decided == state.pars.end() || decided->branches[decided->active].fresh;
  if (!goes_on) {
    goes_on = std::any_of(state.frames.begin() + decided->frames, state.frames.end(), runs_cleanup);
  }
  // A question takes no time: behind one the branch is still on its way to the same perform.
  auto& par = state.pars.back();
  auto& own = par.branches[par.active];
  goes_on = goes_on || own.asks;
  own.asks = goes_on && turn.asks != TurnQuestion::kNone;
  if (goes_on) own.turn = turn;
  put_aside(state, state.pars.size() - 1);
  return next_branch(state);
}

/// Does the instruction neither see nor change anything outside of the running branch? Built-ins
/// fail only where designators are equated.
bool PlanMachine::is_own(const PlanState& state, const PlanInstruction& instruction) const {
  static constexpr PlanOp kOwn[] = {PlanOp::kConstant,  PlanOp::kPop,       PlanOp::kSqueeze,
                                    PlanOp::kJump,      PlanOp::kJumpIfNil, PlanOp::kCall,
                                    PlanOp::kCallLocal, PlanOp::kReturn,    PlanOp::kTick};
  if (instruction.op == PlanOp::kLoad || instruction.op == PlanOp::kStore) {
    return place(state, instruction) >= state.pars.back().height;
  }
  if (instruction.op == PlanOp::kBuiltin) {
    return !code_.identities && state.links.heap.cells.empty();
  }
  if (instruction.op == PlanOp::kLoadGlobal) return !code_.sets_globals;
  return std::find(std::begin(kOwn), std::end(kOwn), instruction.op) != std::end(kOwn);
}

/// Runs on to the next `sleep`, by steps that concern the running branch alone. None: there is no
/// such way, and the state is of no use any more.
std::optional<DatumId> PlanMachine::run_to_sleep(PlanState& state) {
  for (;;) {
    const auto& frame = state.frames.back();
    const auto& instruction = code_.units[frame.unit].code[frame.pc];
    if (instruction.op != PlanOp::kSleep && !is_own(state, instruction)) return std::nullopt;
    if (!count_step()) return std::nullopt;
    ++state.frames.back().pc;
    if (instruction.op == PlanOp::kSleep) {
      state.stack.push_back(values_.nil());
      return instruction.source;
    }
    if (execute(state, instruction)) return std::nullopt;
  }
}

/// Can nobody tell at which of several sleeps in a row the branch waits? Clean-ups that a halt
/// would run can, by its variables, and so can a `par` that is decided: its branches come to no
/// other one.
bool sleeps_are_alike(const PlanState& state) {
  const auto first = state.guards.begin() + state.pars.front().guards;
  return std::none_of(first, state.guards.end(),
                      [](const auto& guard) { return guard.kind == GuardKind::kCleanup; }) &&
         std::none_of(state.pars.begin(), state.pars.end(), [](const PlanPar& par) {
           return par.failure.has_value() || par.value.has_value();
         });
}

/// Waits for a turn. A branch that comes from here to another `sleep` by itself waits there, where
/// nobody can tell the difference. A loop that does nothing but sleep waits at one of its turns, a
/// counted one at every thousandth.
PlanMachine::Step PlanMachine::sleep(PlanState& state, DatumId form) {
  constexpr std::size_t kMostPassed = 1'000;
  std::set<std::vector<std::uint32_t>> passed;
  while (sleeps_are_alike(state) && passed.size() < kMostPassed) {
    auto ahead = state;
    const auto next = run_to_sleep(ahead);
    if (!next || !passed.insert(state_key(ahead, values_, false)).second) break;
    state = std::move(ahead);
    form = *next;
  }
  return wait(state, {values_.nil(), form, true});
}

/// Waits until the fluent is not nil: the branch looks again whenever it has a turn. Outside of
/// branches nobody can change it. With a time limit it waits for one turn, and the fluent stays.
PlanMachine::Step PlanMachine::wait_for(PlanState& state, const PlanInstruction& instruction) {
  const auto fluent = state.stack.back();
  const auto value = fluent_value(state, fluent);
  if (const auto* failure = std::get_if<BuiltinFailure>(&value)) {
    return error(codes::kPlanValue, instruction, failure->text);
  }
  const auto now = std::get<ValueId>(value);
  if (instruction.a == 1) {
    if (!values_.is_nil(now) || state.pars.empty()) return {};
    return wait(state, {values_.nil(), instruction.source, true});
  }
  if (!values_.is_nil(now)) {
    state.stack.back() = now;
    return {};
  }
  if (state.pars.empty()) return StopBound{"wait-for", instruction.source};
  --state.frames.back().pc;
  return wait(state, {values_.nil(), instruction.source, true, fluent});
}

std::variant<ValueId, BuiltinFailure> PlanMachine::fluent_value(const PlanState& state,
                                                                ValueId fluent) {
  auto links = state.links;
  auto result = call_builtin(*find_builtin("value"), std::span(&fluent, 1), code_.classes,
                             limits_.location_samples, links, values_);
  if (const auto* value = std::get_if<ValueId>(&result)) return *value;
  if (const auto* failure = std::get_if<BuiltinFailure>(&result)) return *failure;
  return BuiltinFailure{BuiltinError::kValue, "a fluent that only the model knows"};
}

std::vector<PlanMachine::BranchPath> PlanMachine::waiting(const PlanState& state) {
  std::vector<BranchPath> out;
  BranchPath path;
  find_waiting(state, state.pars.front(), path, out);
  return out;
}

std::vector<PlanMachine::Ending> PlanMachine::endings(const PlanState& state) {
  std::vector<Ending> out;
  BranchPath path;
  find_endings(state.pars.front(), path, out);
  return out;
}

PlanTurn PlanMachine::resume(PlanState& state, const BranchPath& path) {
  for (const auto branch : path) put_in_place(state, branch);
  auto& par = state.pars.back();
  auto& own = par.branches[par.active];
  own.awake = own.turn->sleeps;
  return *std::exchange(own.turn, std::nullopt);
}

bool PlanMachine::waits_to_ask(PlanState& state) {
  if (state.pars.empty()) return false;
  auto& par = state.pars.back();
  return !std::exchange(par.branches[par.active].awake, false);
}

std::optional<PlanStop> PlanMachine::end_par(PlanState& state, const Ending& ending) {
  for (const auto branch : ending.path) put_in_place(state, branch);
  return evaporate(state, ending.end);
}

/// The innermost `par` ends. Of its branches only the clean-ups are left, those of the first branch
/// on top. They run before a value goes on, before a failure does, or once a handler of it has
/// decided or on the way out of the task; or else behind everything that is left of the plan.
PlanMachine::Step PlanMachine::evaporate(PlanState& state, ParEnd end) {
  const auto par = std::move(state.pars.back());
  state.pars.pop_back();
  const bool drops = end == ParEnd::kValueWithoutCleanups || end == ParEnd::kFailureWithoutCleanups;
  for (auto branch = par.branches.rbegin(); branch != par.branches.rend() && !drops; ++branch) {
    keep_cleanups(state, par, *branch, {});
  }
  const auto frame = par.frames - 1;
  if (end == ParEnd::kValue || end == ParEnd::kValueWithoutCleanups)
    return unwind(state, {PendingKind::kExit, frame, *par.exit, *par.value});
  if (end != ParEnd::kFailureAfterCleanups) return search(state, *par.failure, par.guards);
  return unwind(state, {PendingKind::kCross, frame, par.guards, *par.failure});
}

}  // namespace parallax::compiler
