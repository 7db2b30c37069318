#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/line_diff.h"
#include "tools/suite/suite_runner.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kContext = 2;    // common lines around a difference
constexpr std::size_t kMaxShown = 40;  // lines

using Lines = std::vector<std::string_view>;

struct LineEdit {
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

/// Every line of both texts once, deleted ones before the added ones.
std::vector<LineEdit> edits_between(const Lines& a, const Lines& b) {
  std::vector<LineEdit> edits;
  std::size_t next = 0;  // in `a`
  const auto keep_until = [&](std::size_t end) {
    for (; next < end; ++next) edits.push_back({' ', a[next]});
  };
  for (const auto& change : base::line_changes(a, b)) {
    keep_until(change.a_begin);
    for (; next < change.a_end; ++next) edits.push_back({'-', a[next]});
    for (auto k = change.b_begin; k < change.b_end; ++k) edits.push_back({'+', b[k]});
  }
  keep_until(a.size());
  return edits;
}

/// Which edits are shown: the differences and their surroundings.
std::vector<bool> near_differences(const std::vector<LineEdit>& edits) {
  std::vector<bool> near(edits.size(), false);
  for (std::size_t i = 0; i < edits.size(); ++i) {
    if (edits[i].mark == ' ') continue;
    const auto begin = i - std::min(i, kContext);
    const auto end = std::min(edits.size(), i + kContext + 1);
    for (auto k = begin; k < end; ++k) near[k] = true;
  }
  return near;
}

void append(std::string& out, const LineEdit& edit) {
  auto line = edit.line;
  const bool ended = line.ends_with('\n');
  if (ended) line.remove_suffix(1);
  const bool returns = edit.mark != ' ' && line.ends_with('\r');  // which nobody would see
  if (returns) line.remove_suffix(1);
  out += fmt::format("{} {}{}{}\n", edit.mark, line, returns ? " (carriage return)" : "",
                     ended ? "" : " (no line end)");
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
