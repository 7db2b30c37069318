#pragma once

#include <string>
#include <string_view>

namespace parallax::harness {

/// A name or sentence as a picture shows it, escaped for XML: control characters and those that
/// turn the direction of writing as visible escapes, and of a long one the beginning with an
/// ellipsis.
std::string shown_in_full(std::string_view text);                    // 300 characters at most
std::string shown_text(std::string_view text, std::size_t longest);  // not escaped

/// An upper bound on the width of a text in a common sans-serif font [px].
double text_width_px(std::string_view text, double font_px);

}  // namespace parallax::harness
