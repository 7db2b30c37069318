#pragma once

#include <string>
#include <string_view>

namespace parallax::tools {

/// `L1, L2, L3` of ("L", 3).
std::string numbered_names(std::string_view prefix, int count);

}  // namespace parallax::tools
