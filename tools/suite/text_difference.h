#pragma once

#include <string>
#include <string_view>

namespace parallax::tools {

/// How `actual` differs from `expected`, by lines: expected ones with `-`, found ones with `+`, two
/// common lines before and after, line numbers of `expected` at each stretch, the rest counted when
/// it is long. Empty if the texts are the same. Compared as `base::line_changes` does.
std::string text_difference(std::string_view expected, std::string_view actual);

}  // namespace parallax::tools
