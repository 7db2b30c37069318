#pragma once

#include <string>
#include <string_view>

#include "tools/bench/families/families.h"

namespace parallax::tools {

/// `L1, L2, L3` of ("L", 3).
std::string numbered_names(std::string_view prefix, int count);

/// Where a thing of the robot family lies first: odd ones in room 1, even ones in the last.
inline int first_room(int thing, int rooms) { return thing % 2 == 1 ? 1 : rooms; }

// The families as a clingo user would write them by hand: logic programs with only those rules of
// the discrete event calculus that such a model needs. Only the start, the events and released
// fluents are open; effects are derived for events that happen. The answer sets are the traces, one
// each.

/// The rules of the calculus. The models say `fluent`, `happens`, `initiates`, `terminates`,
/// `releases`; `holds` and `happens` are shown.
std::string tuned_calculus(int horizon);

std::string tuned_lamps(int lamps, int horizon);
std::string tuned_distant(int lamps, int horizon);
std::string tuned_robot(int rooms, int things, int slack);
std::string tuned_roaming(int rooms, int things, int horizon);
std::string tuned_pigeon(int pigeons, int holes);
std::string tuned_ringed(int pigeons, int holes);
std::string tuned_chain(int stages);
std::string tuned_bank_projection(const BankSize& size);
std::string tuned_bank_planning(const BankSize& size);
std::string tuned_falling(int horizon);
std::string tuned_grid(int width, int robots, int horizon);
std::string tuned_hanoi(int discs, int horizon);
std::string tuned_logistics(int packages, int trucks, int places, int horizon);

}  // namespace parallax::tools
