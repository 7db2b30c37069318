#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/subprocess.h"

namespace parallax::tools {

/// Runs `git ARGUMENTS...` in a folder. Nothing that the repository there names is executed: no
/// hook, no monitor of its files, no signature program, no pager, none of `emptied`, and nothing is
/// fetched. Environment variables that name another repository are ignored.
base::Captured run_git(const std::string& folder, const std::vector<std::string>& arguments,
                       const std::vector<std::string>& emptied = {});

/// Its output without the last newline; none if it failed or there is no git.
std::optional<std::string> ask_git(const std::string& folder,
                                   const std::vector<std::string>& arguments);

/// The commit that is checked out where a file or folder lies, as 12 digits; none if it lies in no
/// repository, or there is no commit.
std::optional<std::string> revision_at(const std::string& path);

/// Subject and date of a commit.
struct CommitWords {
  std::string subject, date;  // "2026-03-01"
};
/// Those of the commit that is checked out where a file or folder lies.
std::optional<CommitWords> commit_words_at(const std::string& path);

/// revision_at(), followed by `+changes` where one of these files, as far as they lie in that
/// checkout, differs from the commit, and by `+unknown` where git does not tell. The repository's
/// own filters do not run: a file that needs one counts as changed once it was touched.
std::optional<std::string> revision_of(const std::string& path, const std::set<std::string>& files);

}  // namespace parallax::tools
