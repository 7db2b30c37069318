#include "tools/suite/text_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace parallax::tools {
namespace {

constexpr std::size_t kContext = 2;           // common lines around a difference
constexpr std::size_t kMaxShown = 40;         // lines
constexpr std::size_t kMaxTable = 4'000'000;  // cells of 4 bytes

using Lines = std::vector<std::string_view>;

struct Edit {
  char mark;  // ' ', '-' or '+'
  std::string_view line;
};

/// The lines with their ends, so that a missing last line end is a difference too.
Lines lines_of(std::string_view text) {
  Lines lines;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size() - 1) + 1;
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return lines;
}

/// Appends the edits that lead from a[front, a_end) to b[front, b_end) by a longest common
/// subsequence.
void align(const Lines& a, const Lines& b, std::size_t front, std::size_t a_end, std::size_t b_end,
           std::vector<Edit>& edits) {
  const auto rows = a_end - front;
  const auto columns = b_end - front;
  std::size_t i = 0;
  std::size_t j = 0;
  if ((rows + 1) <= kMaxTable / (columns + 1)) {
    // common[i][j]: the length of the longest common subsequence of what follows a[i] and b[j].
    std::vector<std::uint32_t> common((rows + 1) * (columns + 1), 0);
    const auto at = [&](std::size_t row, std::size_t column) -> std::uint32_t& {
      return common[row * (columns + 1) + column];
    };
    for (auto row = rows; row-- > 0;) {
      for (auto column = columns; column-- > 0;) {
        at(row, column) = a[front + row] == b[front + column]
                              ? at(row + 1, column + 1) + 1
                              : std::max(at(row + 1, column), at(row, column + 1));
      }
    }
    while (i < rows && j < columns) {
      if (a[front + i] == b[front + j]) {
        edits.push_back({' ', a[front + i++]});
        ++j;
      } else if (at(i + 1, j) >= at(i, j + 1)) {
        edits.push_back({'-', a[front + i++]});
      } else {
        edits.push_back({'+', b[front + j++]});
      }
    }
  }
  while (i < rows) edits.push_back({'-', a[front + i++]});
  while (j < columns) edits.push_back({'+', b[front + j++]});
}

std::vector<Edit> edits_between(const Lines& a, const Lines& b) {
  const auto shorter = std::min(a.size(), b.size());
  std::size_t front = 0;
  while (front < shorter && a[front] == b[front]) ++front;
  std::size_t back = 0;
  while (back < shorter - front && a[a.size() - 1 - back] == b[b.size() - 1 - back]) ++back;
  std::vector<Edit> edits;
  for (std::size_t i = 0; i < front; ++i) edits.push_back({' ', a[i]});
  align(a, b, front, a.size() - back, b.size() - back, edits);
  for (auto i = a.size() - back; i < a.size(); ++i) edits.push_back({' ', a[i]});
  return edits;
}

/// Which edits are shown: the differences and their surroundings.
std::vector<bool> near_differences(const std::vector<Edit>& edits) {
  std::vector<bool> near(edits.size(), false);
  for (std::size_t i = 0; i < edits.size(); ++i) {
    if (edits[i].mark == ' ') continue;
    const auto begin = i - std::min(i, kContext);
    const auto end = std::min(edits.size(), i + kContext + 1);
    for (auto k = begin; k < end; ++k) near[k] = true;
  }
  return near;
}

void append(std::string& out, const Edit& edit) {
  auto line = edit.line;
  const bool ended = line.ends_with('\n');
  if (ended) line.remove_suffix(1);
  out += fmt::format("{} {}{}\n", edit.mark, line, ended ? "" : " (no line end)");
}

}  // namespace

std::string text_difference(std::string_view expected, std::string_view actual) {
  if (expected == actual) return {};
  const auto edits = edits_between(lines_of(expected), lines_of(actual));
  const auto near = near_differences(edits);
  std::string out = "- expected, + found\n";
  std::size_t line = 1;  // in `expected`
  std::size_t shown = 0;
  std::size_t hidden = 0;  // differing lines beyond the limit
  for (std::size_t i = 0; i < edits.size(); ++i) {
    if (near[i] && shown < kMaxShown) {
      if (i == 0 || !near[i - 1]) out += fmt::format("@ line {}\n", line);
      append(out, edits[i]);
      ++shown;
    } else if (near[i] && edits[i].mark != ' ') {
      ++hidden;
    }
    if (edits[i].mark != '+') ++line;
  }
  if (hidden > 0) out += fmt::format("... {} more differing lines\n", hidden);
  return out;
}

}  // namespace parallax::tools
