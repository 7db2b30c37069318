#pragma once

#include <string>
#include <string_view>

namespace parallax::base {

/// Text for a line or a table's cell of Markdown: nothing in it is markup, a link, a name that is
/// called or another cell.
std::string markdown_text(std::string_view text);

/// A text of several lines as a block that shows it as it is, whatever it holds.
std::string markdown_block(std::string_view text);

}  // namespace parallax::base
