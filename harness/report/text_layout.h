#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace parallax::harness {

inline constexpr std::size_t kReportColumns = 100;

/// `text` broken at blanks so that no line is longer than `columns`; every line starts with
/// `indent` blanks, except the first, which starts with `first`. Words are never broken. Control
/// characters become visible; a newline is a blank. Ends with a newline.
std::string wrapped(std::string_view first, std::string_view text, std::size_t indent,
                    std::size_t columns = kReportColumns);

/// Columns padded to their widest cell, two blanks between them, no blanks at the ends of lines.
std::string table(const std::vector<std::vector<std::string>>& rows, std::size_t indent);

/// Column at which the text beside a label begins.
inline constexpr std::size_t kReportLabels = 15;

/// A line of a report: `indent` blanks, the label, and the text from kReportLabels on, wrapped. A
/// label that is longer pushes the text to the right.
std::string labelled(std::string_view label, std::string_view text, std::size_t indent = 2);

/// `text` as one word of a POSIX shell.
std::string shell_word(const std::string& text);

}  // namespace parallax::harness
