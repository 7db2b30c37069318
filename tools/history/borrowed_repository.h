#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "compiler/base/diagnostic.h"
#include "compiler/base/subprocess.h"

namespace parallax::tools {

/// Is the word a hash as git prints it in full?
bool is_git_hash(std::string_view word);

/// The first line of git's error message.
std::string git_complaint(const base::Captured& git);

/// The commit that the repository at `folder` knows by this name; kUsage if there is none.
base::Result<std::string> commit_of(const std::string& folder, const std::string& revision,
                                    base::DiagnosticSink& sink);

/// A repository of our own, in a folder that goes with whoever made it, which borrows the objects
/// of the user's. The user's repository is only read; none of its hooks, filters and settings are
/// used.
class BorrowedRepository {
 public:
  explicit BorrowedRepository(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::string path() const { return folder_.string(); }
  /// Makes it beside the repository that `user_folder` lies in, and checks out the commit.
  base::Status make(const std::string& user_folder, const std::string& commit,
                    base::DiagnosticSink& sink);
  base::Status check_out(const std::string& commit, base::DiagnosticSink& sink);
  /// Checks out a commit in a new folder of its own. False if that failed.
  bool add_tree(const std::filesystem::path& folder, const std::string& commit) const;
  std::string subject(const std::string& commit) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace parallax::tools
