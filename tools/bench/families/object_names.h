#pragma once

#include <string>
#include <string_view>

namespace parallax::tools {

/// `L1, L2, L3` of ("L", 3).
std::string numbered_names(std::string_view prefix, int count);

/// Where a thing of the robot family lies first: odd ones in room 1, even ones in the last.
inline int first_room(int thing, int rooms) { return thing % 2 == 1 ? 1 : rooms; }

}  // namespace parallax::tools
