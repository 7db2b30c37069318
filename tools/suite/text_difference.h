#pragma once

#include <string>
#include <string_view>

namespace parallax::tools {

/// How `actual` differs from `expected`, by lines: expected ones with `-`, found ones with `+`, two
/// common lines before and after, line numbers of `expected` at each stretch, the rest counted when
/// it is long. Empty if the texts are the same. Texts that differ over some thousand lines are
/// compared as one stretch; otherwise the cost is the product of the differing parts.
std::string text_difference(std::string_view expected, std::string_view actual);

}  // namespace parallax::tools
