#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::base {

/// The lines [a_begin, a_end) of one text give way to the lines [b_begin, b_end) of another; either
/// may be empty, not both. Counted from 0.
struct LineChange {
  std::size_t a_begin = 0, a_end = 0;
  std::size_t b_begin = 0, b_end = 0;
  friend bool operator==(const LineChange&, const LineChange&) = default;
};

/// Changes that turn `a` into `b`, from the first line to the last; two changes are separated by a
/// common line. As few lines as possible are deleted and added, each change as far down as equal
/// lines let it; texts that differ in more than some thousand lines are compared as one stretch.
///
/// Myers, "An O(ND) Difference Algorithm and Its Variations" (1986), section 4: time O((N + M) D)
/// and space O(D^2) for D deletions and additions.
std::vector<LineChange> line_changes(std::span<const std::string_view> a,
                                     std::span<const std::string_view> b);

/// The same in the normal form of POSIX diff: `2c2`, `5,7c5`, `3a4,5`, `8d7`, the old lines behind
/// `< `, the new ones behind `> `, `---` between the two. Empty if they are equal.
std::string normal_diff(const std::vector<std::string>& before,
                        const std::vector<std::string>& after);

}  // namespace parallax::base
