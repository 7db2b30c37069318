#include "compiler/base/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"

namespace parallax::base {

Result<FolderLock> FolderLock::claim(const std::filesystem::path& path, DiagnosticSink& sink) {
  FolderLock lock;
  lock.path_ = path;
  std::error_code error;
  auto folder = path;
  while (!folder.empty() && !std::filesystem::exists(folder, error)) {
    lock.made_.push_back(folder);
    folder = folder.parent_path();
  }
  std::filesystem::create_directories(path, error);
  if (error) return sink.error_about(codes::kFileNotWritable, path.string(), error.message());
  lock.fd_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock.fd_ >= 0 && ::flock(lock.fd_, LOCK_EX | LOCK_NB) == 0) return lock;
  const int why = errno;
  lock.made_.clear();  // whoever holds it may be about to use it
  if (why == EWOULDBLOCK) return sink.error_about(codes::kFolderInUse, path.string());
  return sink.error_about(codes::kFileNotWritable, path.string(), std::strerror(why));
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : path_(std::move(other.path_)),
      fd_(std::exchange(other.fd_, -1)),
      made_(std::exchange(other.made_, {})) {}

FolderLock::~FolderLock() {
  // A folder that is not empty stays, and so do those above it.
  for (const auto& folder : made_) {
    if (::rmdir(folder.c_str()) != 0) break;
  }
  if (fd_ >= 0) ::close(fd_);
}

}  // namespace parallax::base
