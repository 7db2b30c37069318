#include "harness/report/text_layout.h"

#include <algorithm>

#include "compiler/base/ascii.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/utf8.h"

namespace parallax::harness {

std::string wrapped(std::string_view first, std::string_view text, std::size_t indent,
                    std::size_t columns) {
  std::string plain(text);
  std::replace(plain.begin(), plain.end(), '\n', ' ');
  plain = base::printable(plain);
  std::string out(first);
  std::size_t column = base::count_code_points(first);
  bool at_start = true;
  for (std::size_t at = 0; at < plain.size();) {
    const auto end = std::min(plain.find(' ', at), plain.size());
    const auto word = std::string_view(plain).substr(at, end - at);
    at = end + 1;
    if (word.empty()) continue;
    const auto width = base::count_code_points(word);
    if (!at_start && column + 1 + width > columns) {
      out += '\n' + std::string(indent, ' ');
      column = indent;
      at_start = true;
    }
    if (!at_start) out += ' ', ++column;
    out += word;
    column += width;
    at_start = false;
  }
  return out + '\n';
}

std::string table(const std::vector<std::vector<std::string>>& rows, std::size_t indent) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], base::count_code_points(base::printable(row[i])));
    }
  }
  std::string out;
  for (const auto& row : rows) {
    std::string line(indent, ' ');
    for (std::size_t i = 0; i < row.size(); ++i) {
      const auto cell = base::printable(row[i]);
      line += cell + std::string(widths[i] - base::count_code_points(cell) + 2, ' ');
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + '\n';
  }
  return out;
}

std::string labelled(std::string_view label, std::string_view text, std::size_t indent) {
  const auto end = std::max(kReportLabels, indent + label.size() + 1);
  auto first = std::string(indent, ' ') + std::string(label);
  first.resize(end, ' ');
  return wrapped(first, text, end);
}

std::string shell_word(const std::string& text) {
  const bool plain =
      !text.empty() && text.front() != '-' && std::all_of(text.begin(), text.end(), [](char c) {
        return base::is_name_character(c) ||
               std::string_view("/.-+=:,@%").find(c) != std::string_view::npos;
      });
  if (plain) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace parallax::harness
