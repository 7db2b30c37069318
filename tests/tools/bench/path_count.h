#pragma once

#include <cstdint>

namespace parallax::test {

// The numbers of traces of some families, counted in their own terms: paths of a graph of states,
// with no formula and no solver.

/// Number of courses in `robot_model(rooms, things, slack)`: at each step the robot waits, goes to
/// a next room, grasps what is there or drops what it carries.
std::int64_t robot_courses(int rooms, int things, int slack);

/// Number of the same courses in `roaming_model(rooms, things, horizon)`, wherever they end.
std::int64_t roaming_courses(int rooms, int things, int horizon);

/// Number of series of transfers and pauses in `bank_planning_model({accounts, max_balance,
/// max_amount, horizon})` after which the first account has everything.
std::int64_t transfer_series(int accounts, int max_balance, int max_amount, int horizon);

/// Number of courses in `hanoi_task(discs, horizon)` after which all discs are on the right.
std::int64_t hanoi_courses(int discs, int horizon);

/// Number of courses in `grid_task(width, robots, horizon)` after which each robot is at its goal.
std::int64_t grid_courses(int width, int robots, int horizon);

/// Number of courses in `logistics_task(packages, trucks, places, horizon)` after which each
/// package is at its goal.
std::int64_t logistics_courses(int packages, int trucks, int places, int horizon);

}  // namespace parallax::test
