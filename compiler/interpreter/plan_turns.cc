// Choices between the branches of a `par` that wait for their turn, as free branches of the graph.
// A branch that sleeps or asks the model performs nothing at its turn, so the number of such turns
// since the last perform is part of a choice's identity: no cycle consists of choices alone.
#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/interpreter/explorer.h"

namespace parallax::compiler {

namespace {

std::string_view choice_of(PlanMachine::ParEnd end) {
  switch (end) {
    case PlanMachine::ParEnd::kValue:
      return "the `pursue` ends";
    case PlanMachine::ParEnd::kValueWithoutCleanups:
      return "the `pursue` ends, its clean-ups come last";
    case PlanMachine::ParEnd::kFailure:
      return "the branches fail";
    case PlanMachine::ParEnd::kFailureAfterCleanups:
      return "the branches fail after the clean-ups";
    case PlanMachine::ParEnd::kFailureWithoutCleanups:
      return "the branches fail, the clean-ups come last";
  }
  return "";
}

}  // namespace

/// Any branch of a `par` that waits may go on, and a `par` that is decided may end.
std::optional<PlanTarget> Explorer::take_turns(const PlanState& state) {
  const auto waiting = machine_.waiting(state);
  const auto endings = PlanMachine::endings(state);
  const auto ways = waiting.size() + endings.size();
  std::uint32_t turn = 0;
  const auto go_on = [&](std::size_t way, Job::Edge edge, std::uint32_t owner) {
    Job next{state, {}, {}, edge, owner};
    if (way < waiting.size()) {
      const auto resumed = PlanMachine::resume(next.state, waiting[way]);
      const bool asks = resumed.asks != TurnQuestion::kNone;
      if (asks) next.ask = resumed;
      if (asks || resumed.sleeps) {
        ++next.state.slept;
        next.state.asleep = turn;
      } else {
        next.act = StopPerform{resumed.designator, resumed.form};
      }
    } else {
      next.ending = endings[way - waiting.size()];
    }
    return next;
  };
  if (ways == 1) {
    auto next = go_on(0, Job::Edge::kEntry, 0);
    return advance(next);
  }
  const auto form = state.pars.front().form;
  // All that is left waits for fluents that nobody changes any more.
  if (ways == 0) return terminal(TerminalKind::kBound, "wait-for", form);
  const auto drops = [](const PlanMachine::Ending& ending) {
    return ending.end == PlanMachine::ParEnd::kValueWithoutCleanups ||
           ending.end == PlanMachine::ParEnd::kFailureWithoutCleanups;
  };
  if (std::any_of(endings.begin(), endings.end(), drops)) late_cleanups_.insert(form);
  auto key = state_key(state, values_, false);
  if (state.slept > 0) {
    // A branch that sleeps or asks again and again while nothing else happens: nothing comes of it.
    key.push_back(state.slept - 1);
    const auto before = turns_.find(key);
    if (before != turns_.end() && before->second.index() + 1 == state.asleep) {
      return terminal(TerminalKind::kNever, {}, std::nullopt);
    }
    key.pop_back();
  }
  if (state.slept > options_.limits.max_loop) return terminal(TerminalKind::kBound, "sleep", form);
  key.push_back(state.slept);  // so that no cycle consists of turns alone
  const auto found = turns_.find(key);
  if (found != turns_.end()) return found->second;
  if (!has_room(key, form)) return std::nullopt;
  const auto choice = [&](std::size_t way) {
    const bool goes_on = way < waiting.size();
    return free_branch(goes_on ? (way == 0 ? "the first branch goes on" : "the next branch goes on")
                               : std::string(choice_of(endings[way - waiting.size()].end)),
                       form);
  };
  const auto first = choice(0);
  turn = first.index() + 1;
  turns_.emplace(std::move(key), first);
  auto here = first;
  // The last job is taken first: branches in written order.
  std::vector<Job> jobs;
  for (std::size_t way = 0; way + 1 < ways; ++way) {
    jobs.push_back(go_on(way, Job::Edge::kTrue, here.index()));
    if (way + 2 == ways) {
      jobs.push_back(go_on(way + 1, Job::Edge::kFalse, here.index()));
    } else {
      const auto next = choice(way + 1);
      graph_.branches[here].if_false = next;
      here = next;
    }
  }
  jobs_.insert(jobs_.end(), std::make_move_iterator(jobs.rbegin()),
               std::make_move_iterator(jobs.rend()));
  return first;
}

/// The next thing that the job does: a question that a branch waited to ask, a perform that is to
/// begin, or what the machine comes to.
PlanStop Explorer::next_stop(Job& job) {
  const auto asked = std::exchange(job.ask, std::nullopt);
  job.in_turn = asked.has_value();
  if (!asked) {
    if (job.begin) return *std::exchange(job.begin, std::nullopt);
    return machine_.run(job.state);
  }
  const auto form = asked->form;
  switch (asked->asks) {
    case TurnQuestion::kFluent:
      return StopQuestion{asked->designator, form};
    case TurnQuestion::kProof:
      return StopProof{asked->designator, form};
    case TurnQuestion::kAllProofs:
      return StopProof{asked->designator, form, true};
    case TurnQuestion::kGrounding:
      job.proof = StopPerform{resolve_links(job.state.links, values_, asked->designator), form};
      break;
    case TurnQuestion::kNone:
    case TurnQuestion::kGoal:
      break;
  }
  return StopPerform{asked->designator, form};
}

}  // namespace parallax::compiler
