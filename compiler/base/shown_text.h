#pragma once

#include <string>
#include <string_view>

namespace parallax::base {

// The output gate. Names, comments, file names, and whatever simulators and logs say may hold
// anything. What is shown to people passes one of these functions on its way out of the program:
// escapes for terminals, which obey control characters and those that turn the direction of
// writing; for CI systems, which read lines such as `::error::` as commands; and for spreadsheets,
// which compute cells such as `=1+1`.

/// Does the character steer what shows it? Control characters (C0, DEL, C1), separators of lines
/// and paragraphs, and marks that turn the direction of writing.
bool steers_display(char32_t c);

/// One line of text: every character that steers a display, line ends and tabs included, as
/// `\u001b`, and bytes that are no UTF-8 as `\xff`.
std::string printable(std::string_view text);

struct LinesStyle {
  bool colors = false;    // the program's own colours stay, such as `ESC [1;31m`
  bool commands = false;  // lines such as `::error::` stay: they are meant for a CI system
};

/// Text of several lines: as `printable`, but tabs and line ends stay. The colon or number sign
/// that would make a line a command of a CI system (`::error::`, `##vso[`) becomes an escape. In
/// JSON the result says the same, as escapes are those of JSON.
std::string shown_lines(std::string_view text, const LinesStyle& style = {});

/// HTML, SVG or XML: as `shown_lines`, but lines may begin with anything.
std::string shown_markup(std::string_view text);

/// How a text leaves the program.
enum class TextForm {
  kLines,   // `shown_lines`
  kMarkup,  // `shown_markup`
  kExact    // byte by byte: models, plans, patches and other inputs of programs
};
std::string shown(std::string_view text, TextForm form);

/// A cell of a CSV file (RFC 4180): printable and quoted where need be. A text that a spreadsheet
/// would compute, as it begins with one of `=+-@`, gets an apostrophe in front; numbers stay.
std::string csv_cell(std::string_view text);

}  // namespace parallax::base
