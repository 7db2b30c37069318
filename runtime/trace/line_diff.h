#pragma once

#include <string>
#include <vector>

namespace parallax::runtime {

using Lines = std::vector<std::string>;

/// The commands that turn `before` into `after`, in the normal form of POSIX diff: `2c2`, `5,7c5`,
/// `3a4,5`, `8d7`, the old lines behind `< `, the new ones behind `> `, `---` between the two.
/// Empty if they are equal. As few lines as possible are deleted and added; texts that differ in
/// more than some thousand lines are compared as one stretch.
///
/// Myers, "An O(ND) Difference Algorithm and Its Variations" (1986), section 4: time O((N + M) D)
/// and space O(D^2) for D deletions and additions.
std::string normal_diff(const Lines& before, const Lines& after);

}  // namespace parallax::runtime
