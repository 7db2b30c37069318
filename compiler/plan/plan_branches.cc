// `par` whose branches take turns, perform by perform. All branches begin at the same height of
// frames, guards and stack; the one that runs is in place, the others are kept aside.
#include <iterator>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/plan_machine.h"

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
  own.pars = std::move(nested);
  own.frames = take_above(state.frames, par.frames);
  own.guards = take_above(state.guards, par.guards);
  own.stack = take_above(state.stack, par.height);
}

bool has_cleanup(const PlanBranchState& branch) {
  for (const auto& guard : branch.guards) {
    if (guard.cleanup) return true;
  }
  for (const auto& frame : branch.frames) {
    if (frame.kind == FrameKind::kCleanup) return true;
  }
  for (const auto& par : branch.pars) {
    for (const auto& inner : par.branches) {
      if (has_cleanup(inner)) return true;
    }
  }
  return false;
}

void find_waiting(const PlanPar& par, PlanMachine::BranchPath& path,
                  std::vector<PlanMachine::BranchPath>& out) {
  for (std::size_t i = 0; i < par.branches.size(); ++i) {
    const auto& branch = par.branches[i];
    path.push_back(i);
    if (branch.turn) out.push_back(path);
    if (!branch.pars.empty()) find_waiting(branch.pars.front(), path, out);
    path.pop_back();
  }
}

}  // namespace

PlanMachine::Step PlanMachine::start_par(PlanState& state, const PlanInstruction& instruction) {
  PlanPar par;
  par.frames = static_cast<std::uint32_t>(state.frames.size());
  par.guards = static_cast<std::uint32_t>(state.guards.size());
  par.height = static_cast<std::uint32_t>(state.stack.size());
  par.form = instruction.source;
  for (const auto unit : code_.pars[instruction.a]) {
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
  own.result = state.stack.back();
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
    if (all_done) {
      const auto result = par.branches.back().result;  // as in written order
      state.pars.pop_back();
      state.stack.push_back(result);
      return {};
    }
    if (state.pars.size() == 1) return StopTurn{};
    put_aside(state, state.pars.size() - 2);
  }
}

std::optional<PlanStop> PlanMachine::wait(PlanState& state, const StopPerform& perform) {
  auto& par = state.pars.back();
  par.branches[par.active].turn = PlanTurn{perform.designator, perform.form};
  put_aside(state, state.pars.size() - 1);
  return next_branch(state);
}

std::vector<PlanMachine::BranchPath> PlanMachine::waiting(const PlanState& state) {
  std::vector<BranchPath> out;
  BranchPath path;
  find_waiting(state.pars.front(), path, out);
  return out;
}

StopPerform PlanMachine::resume(PlanState& state, const BranchPath& path) {
  for (const auto branch : path) put_in_place(state, branch);
  auto& par = state.pars.back();
  auto& turn = par.branches[par.active].turn;
  const StopPerform out{turn->designator, turn->form};
  turn.reset();
  return out;
}

/// Control leaves for this frame: what other branches of `par`s above it were about is over.
PlanMachine::Step PlanMachine::abandon_branches(PlanState& state, std::size_t frame) {
  while (!state.pars.empty() && frame < state.pars.back().frames) {
    const auto& par = state.pars.back();
    for (const auto& branch : par.branches) {
      if (!has_cleanup(branch)) continue;
      sink_.error(
          base::DiagnosticCode::kUnsupportedPlanForm, data_.source(par.form), "par",
          "a branch is left while another one is inside `unwind-protect`; take the branches "
          "in order");
      return StopError{};
    }
    state.pars.pop_back();
  }
  return {};
}

}  // namespace parallax::compiler
