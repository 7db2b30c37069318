#include "tests/tools/bench/path_count.h"

#include <functional>
#include <map>
#include <vector>

namespace parallax::test {
namespace {

using State = std::vector<int>;
using Successors = std::function<std::vector<State>(const State&)>;

/// Paths of `steps` steps from `start` to a state that `is_goal` accepts.
std::int64_t paths(const State& start, int steps, const Successors& successors,
                   const std::function<bool(const State&)>& is_goal) {
  std::map<State, std::int64_t> reached = {{start, 1}};
  for (int step = 0; step < steps; ++step) {
    std::map<State, std::int64_t> next;
    for (const auto& [state, ways] : reached) {
      for (const auto& successor : successors(state)) next[successor] += ways;
    }
    reached = std::move(next);
  }
  std::int64_t sum = 0;
  for (const auto& [state, ways] : reached) sum += is_goal(state) ? ways : 0;
  return sum;
}

/// Room of the robot, number of the carried thing or 0, rooms of the things.
std::vector<State> robot_moves(const State& state, int rooms) {
  std::vector<State> next = {state};
  const auto carried = static_cast<std::size_t>(state[1]);
  for (const int room : {state[0] - 1, state[0] + 1}) {
    if (room < 1 || room > rooms) continue;
    State moved = state;
    moved[0] = room;
    if (carried != 0) moved[carried + 1] = room;
    next.push_back(moved);
  }
  for (std::size_t thing = 1; thing + 1 < state.size(); ++thing) {
    if (carried != 0 || state[thing + 1] != state[0]) continue;
    State grasped = state;
    grasped[1] = static_cast<int>(thing);
    next.push_back(grasped);
  }
  if (carried != 0) {
    State dropped = state;
    dropped[1] = 0;
    next.push_back(dropped);
  }
  return next;
}

State robot_start(int rooms, int things) {
  State start = {1, 0};
  for (int thing = 1; thing <= things; ++thing) start.push_back(thing % 2 == 1 ? 1 : rooms);
  return start;
}

std::vector<State> transfers(const State& balances, int max_balance, int max_amount) {
  std::vector<State> next = {balances};
  for (std::size_t from = 0; from < balances.size(); ++from) {
    for (std::size_t to = 0; to < balances.size(); ++to) {
      for (int amount = 1; from != to && amount <= max_amount; ++amount) {
        if (balances[from] < amount || balances[to] + amount > max_balance) continue;
        State after = balances;
        after[from] -= amount;
        after[to] += amount;
        next.push_back(after);
      }
    }
  }
  return next;
}

}  // namespace

std::int64_t robot_courses(int rooms, int things, int slack) {
  State goal = {0, 0};
  for (int thing = 1; thing <= things; ++thing) goal.push_back(thing % 2 == 1 ? rooms : 1);
  return paths(
      robot_start(rooms, things), things * (rooms + 1) + slack,
      [&](const State& state) { return robot_moves(state, rooms); },
      [&](State state) {
        state[0] = 0;  // the robot may be anywhere
        return state == goal;
      });
}

std::int64_t roaming_courses(int rooms, int things, int horizon) {
  return paths(
      robot_start(rooms, things), horizon,
      [&](const State& state) { return robot_moves(state, rooms); },
      [](const State&) { return true; });
}

std::int64_t transfer_series(int accounts, int max_balance, int max_amount, int horizon) {
  const State start(static_cast<std::size_t>(accounts), max_balance / accounts);
  return paths(
      start, horizon,
      [&](const State& balances) { return transfers(balances, max_balance, max_amount); },
      [&](const State& balances) { return balances[0] == max_balance; });
}

}  // namespace parallax::test
