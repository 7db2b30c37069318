#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/base/subprocess.h"

namespace parallax::tools {

/// Runs `git ARGUMENTS...` in a folder. Nothing that the repository there names is executed: no
/// hook, no monitor of its files, no signature program, no pager, and nothing is fetched. What the
/// environment says of another repository does not count.
base::Captured run_git(const std::string& folder, const std::vector<std::string>& arguments);

/// Its output without the last newline; none if it failed or there is no git.
std::optional<std::string> ask_git(const std::string& folder,
                                   const std::vector<std::string>& arguments);

/// The commit that is checked out where a file or folder lies, as 12 digits; none if it lies in no
/// repository, or there is no commit. Whether files have changed since is not asked: git would have
/// to run the repository's own filters for that.
std::optional<std::string> revision_at(const std::string& path);

}  // namespace parallax::tools
