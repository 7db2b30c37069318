#include "harness/campaign/run_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "harness/campaign/journal.h"

namespace parallax::harness {

using base::DiagnosticCode;

base::Result<RunFolder> RunFolder::claim(const std::filesystem::path& path, bool resume,
                                         base::DiagnosticSink& sink) {
  RunFolder folder;
  folder.path_ = path;
  std::error_code error;
  folder.made_ = std::filesystem::create_directories(path, error);
  if (error) {
    return sink.error_about(DiagnosticCode::kFileNotWritable, path.string(), error.message());
  }
  folder.fd_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder.fd_ < 0 || ::flock(folder.fd_, LOCK_EX | LOCK_NB) != 0) {
    const int why = errno;
    folder.made_ = false;  // whoever holds it may be about to use it
    if (why == EWOULDBLOCK) return sink.error_about(DiagnosticCode::kRunFolderInUse, path.string());
    return sink.error_about(DiagnosticCode::kFileNotWritable, path.string(), std::strerror(why));
  }
  if (!resume && std::filesystem::exists(path / kJournalName, error)) {
    return sink.error_about(DiagnosticCode::kRunFolderInUse, path.string());
  }
  return folder;
}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : path_(std::move(other.path_)),
      fd_(std::exchange(other.fd_, -1)),
      made_(std::exchange(other.made_, false)) {}

RunFolder::~RunFolder() {
  if (made_) ::rmdir(path_.c_str());  // which leaves alone a folder that is not empty
  if (fd_ >= 0) ::close(fd_);
}

}  // namespace parallax::harness
