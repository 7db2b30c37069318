#pragma once

#include <string>
#include <string_view>

namespace parallax::tools {

/// First line of what `diff --markdown` writes, by which it knows its own files again.
inline constexpr std::string_view kDiffMark = "<!-- parallax diff -->";

/// The text of `parallax diff` for a pull request: what stands without indentation becomes a
/// paragraph, the lines below it a block in which added and removed lines are coloured.
std::string diff_markdown(const std::string& old_name, const std::string& new_name,
                          std::string_view text);

}  // namespace parallax::tools
