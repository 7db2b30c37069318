#include "compiler/base/line_diff.h"

#include <doctest/doctest.h>

#include <sstream>

#include "tests/support/recorded_answer.h"

namespace parallax::test {
namespace {

using base::LineChange;
using base::normal_diff;
using Lines = std::vector<std::string>;

Lines split(const std::string& text) {
  Lines lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string joined(const Lines& lines) {
  std::string out;
  for (const auto& line : lines) out += line + '\n';
  return out;
}

/// Lines over a small alphabet, from a linear congruential generator.
Lines random_lines(std::uint32_t& state, std::size_t most) {
  const auto next = [&] { return (state = state * 1664525U + 1013904223U) >> 16U; };
  Lines lines(next() % (most + 1));
  for (auto& line : lines) line = std::string(1, static_cast<char>('a' + next() % 4));
  return lines;
}

std::size_t edit_count(const std::string& difference) {
  std::size_t count = 0;
  for (const auto& line : split(difference)) {
    if (line.starts_with("< ") || line.starts_with("> ")) ++count;
  }
  return count;
}

TEST_CASE("equal texts have no difference, and each kind of command has its form") {
  CHECK(normal_diff({}, {}).empty());
  CHECK(normal_diff({"a"}, {"a"}).empty());
  CHECK(normal_diff({"a", "b"}, {"a", "x", "y", "b"}) == "1a2,3\n> x\n> y\n");
  CHECK(normal_diff({"a", "b", "c"}, {"a", "c"}) == "2d1\n< b\n");
  CHECK(normal_diff({"a", "b", "c"}, {"a", "x", "c"}) == "2c2\n< b\n---\n> x\n");
  CHECK(normal_diff({}, {"x"}) == "0a1\n> x\n");
  CHECK(normal_diff({"x", "y"}, {}) == "1,2d0\n< x\n< y\n");
}

TEST_CASE("changes are as far down as equal lines let them be, a common line between two") {
  using Views = std::vector<std::string_view>;
  using Changes = std::vector<LineChange>;
  CHECK(base::line_changes(Views{"a"}, Views{"a"}).empty());
  CHECK(base::line_changes(Views{"a", "b"}, Views{"a", "b", "b"}) == Changes{{2, 2, 2, 3}});
  CHECK(base::line_changes(Views{"a", "b", "c"}, Views{"x", "b", "y"}) ==
        Changes{{0, 1, 0, 1}, {2, 3, 2, 3}});
}

TEST_CASE("a difference applied to the old lines gives the new ones, in as few edits as possible") {
  std::uint32_t state = 20261;
  for (int round = 0; round < 3000; ++round) {
    const auto before = random_lines(state, 12), after = random_lines(state, 12);
    const auto difference = normal_diff(before, after);
    CAPTURE(joined(before));
    CAPTURE(joined(after));
    REQUIRE(RecordedAnswer::patched(before, split(difference)) == after);
    // The longest common subsequence, by the textbook's table.
    std::vector<std::vector<std::size_t>> common(before.size() + 1,
                                                 std::vector<std::size_t>(after.size() + 1, 0));
    for (std::size_t i = 1; i <= before.size(); ++i) {
      for (std::size_t j = 1; j <= after.size(); ++j) {
        common[i][j] = before[i - 1] == after[j - 1] ? common[i - 1][j - 1] + 1
                                                     : std::max(common[i - 1][j], common[i][j - 1]);
      }
    }
    REQUIRE(edit_count(difference) ==
            before.size() + after.size() - 2 * common[before.size()][after.size()]);
  }
}

TEST_CASE("texts that differ everywhere are one change, however long they are") {
  Lines before, after;
  for (int i = 0; i < 5000; ++i) {
    before.push_back("a" + std::to_string(i));
    after.push_back("b" + std::to_string(i));
  }
  before.insert(before.begin(), "same");
  after.insert(after.begin(), "same");
  const auto difference = normal_diff(before, after);
  CHECK(difference.starts_with("2,5001c2,5001\n"));
  CHECK(RecordedAnswer::patched(before, split(difference)) == after);
}

}  // namespace
}  // namespace parallax::test
