#pragma once

#include <cstdint>

namespace parallax::test {

// The numbers of traces of two families, counted in their own terms: paths of a graph of states,
// with no formula and no solver.

/// Number of courses in `robot_model(rooms, things, slack)`: at each step the robot waits, goes to
/// a next room, grasps what is there or drops what it carries.
std::int64_t robot_courses(int rooms, int things, int slack);

/// Number of the same courses in `roaming_model(rooms, things, horizon)`, wherever they end.
std::int64_t roaming_courses(int rooms, int things, int horizon);

/// Number of series of transfers and pauses in `bank_planning_model({accounts, max_balance,
/// max_amount, horizon})` after which the first account has everything.
std::int64_t transfer_series(int accounts, int max_balance, int max_amount, int horizon);

}  // namespace parallax::test
