#pragma once

#include <string>
#include <string_view>

namespace parallax::tools {

/// Text for elements and attributes of HTML alike: markup as entities; control characters,
/// characters that turn the direction of writing and bytes that are no UTF-8 as visible escapes.
std::string html(std::string_view text);

/// A sentence, whose `names` in backticks are set as code.
std::string html_words(std::string_view text);

/// The same as `html`, line by line.
std::string html_lines(std::string_view text);

/// A name or sentence from a run folder, of whatever length: beyond 300 bytes its beginning and
/// how long it is. Escaped.
std::string html_short(std::string_view text);

/// "0.474", "1.2e-07": `digits` significant ones.
std::string number(double value, int digits = 3);
/// "4.99 %"
std::string percent(double share);

/// A text of a data block: as `html` shows it, quoted as JSON does, and nothing in it that ends a
/// script element.
std::string json_word(std::string_view text);

/// A source line with comments, strings, numbers and words of the language in `<b class=..>`
/// elements; languages are told by the ending of the file's name (.e, .lisp, .bind, .yaml).
std::string coloured(std::string_view line, std::string_view file);

}  // namespace parallax::tools
