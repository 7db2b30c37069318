#include "tests/tools/bench/path_count.h"

#include <algorithm>
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

namespace {

/// Pegs of the discs, the smallest first.
std::vector<State> hanoi_moves(const State& pegs) {
  std::vector<State> next = {pegs};
  for (std::size_t disc = 0; disc < pegs.size(); ++disc) {
    for (int peg = 0; peg < 3; ++peg) {
      bool free = peg != pegs[disc];
      for (std::size_t smaller = 0; smaller < disc; ++smaller) {
        free = free && pegs[smaller] != peg && pegs[smaller] != pegs[disc];
      }
      if (!free) continue;
      next.push_back(pegs);
      next.back()[disc] = peg;
    }
  }
  return next;
}

/// Cells of the robots, counted from 0. Every combination of single moves in which no two meet.
std::vector<State> grid_moves(const State& cells, int width) {
  std::vector<State> next = {{}};
  for (std::size_t robot = 0; robot < cells.size(); ++robot) {
    std::vector<State> longer;
    for (const auto& part : next) {
      const int x = cells[robot] % width, y = cells[robot] / width;
      for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        if (x + dx < 0 || x + dx >= width || y + dy < 0 || y + dy >= width) continue;
        const int cell = (y + dy) * width + x + dx;
        bool free = true;
        for (std::size_t other = 0; other < robot; ++other) {
          const bool swaps = part[other] == cells[robot] && cells[other] == cell;
          free = free && part[other] != cell && !swaps;
        }
        if (!free) continue;
        longer.push_back(part);
        longer.back().push_back(cell);
      }
    }
    next = std::move(longer);
  }
  return next;
}

/// Places of the packages (-1 - truck for one in a truck), then of the trucks.
std::vector<State> logistics_moves(const State& state, int packages, int trucks, int places) {
  std::vector<State> next = {state};
  for (int truck = 0; truck < trucks; ++truck) {
    const auto at = static_cast<std::size_t>(packages + truck);
    std::vector<State> after;
    for (const auto& part : next) {
      after.push_back(part);
      for (int place = 0; place < places; ++place) {
        if (place == state[at]) continue;
        after.push_back(part);
        after.back()[at] = place;
      }
      int load = -1;
      for (int package = 0; package < packages; ++package) {
        if (state[static_cast<std::size_t>(package)] == -1 - truck) load = package;
      }
      for (int package = 0; package < packages; ++package) {
        const auto p = static_cast<std::size_t>(package);
        // Another truck may have taken it in this step.
        const bool takes = load < 0 && state[p] == state[at] && part[p] == state[p];
        if (!takes && package != load) continue;
        after.push_back(part);
        after.back()[p] = takes ? -1 - truck : state[at];
      }
    }
    next = std::move(after);
  }
  return next;
}

}  // namespace

std::int64_t hanoi_courses(int discs, int horizon) {
  const State start(static_cast<std::size_t>(discs), 0), goal(start.size(), 2);
  return paths(start, horizon, hanoi_moves, [&](const State& state) { return state == goal; });
}

std::int64_t grid_courses(int width, int robots, int horizon) {
  State start, goal;
  for (int robot = 0; robot < robots; ++robot) {
    start.push_back(robot * width * width / robots);
    goal.push_back(width * width - 1 - start.back());
  }
  return paths(
      start, horizon, [&](const State& state) { return grid_moves(state, width); },
      [&](const State& state) { return state == goal; });
}

std::int64_t logistics_courses(int packages, int trucks, int places, int horizon) {
  State start;
  std::vector<int> goal;
  for (int package = 0; package < packages; ++package) {
    start.push_back(package % places);
    goal.push_back((package % places + 1 + package / places) % places);
  }
  start.insert(start.end(), static_cast<std::size_t>(trucks), 0);
  return paths(
      start, horizon,
      [&](const State& state) { return logistics_moves(state, packages, trucks, places); },
      [&](const State& state) { return std::equal(goal.begin(), goal.end(), state.begin()); });
}

}  // namespace parallax::test
