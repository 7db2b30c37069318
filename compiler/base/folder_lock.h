#pragma once

#include <filesystem>
#include <vector>

#include "compiler/base/diagnostic.h"

namespace parallax::base {

/// A folder that one process writes to, claimed for as long as the object lives. The lock is on the
/// folder itself (flock), so that it leaves no file behind and ends with the process.
class FolderLock {
 public:
  /// Makes the folder if it is missing. Reports kFolderInUse when another process holds it, else
  /// kFileNotWritable.
  static Result<FolderLock> claim(const std::filesystem::path& path, DiagnosticSink& sink);
  /// Gives the folder back; removes it, and those above it, if it was made here and nothing was put
  /// into it.
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  FolderLock() = default;

  std::filesystem::path path_;
  int fd_ = -1;
  std::vector<std::filesystem::path> made_;  // the innermost first
};

}  // namespace parallax::base
