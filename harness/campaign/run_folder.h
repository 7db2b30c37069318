#pragma once

#include <filesystem>

#include "compiler/base/diagnostic.h"

namespace parallax::harness {

/// The folder of one run, claimed for as long as the object lives: by a lock on the folder itself,
/// as a lock file would be one more file in it and the journal is replaced at the end.
class RunFolder {
 public:
  /// Makes the folder if it is missing. Reports kRunFolderInUse when another run holds it, or when
  /// it has a journal and is not to be continued (`resume`); else kFileNotWritable.
  static base::Result<RunFolder> claim(const std::filesystem::path& path, bool resume,
                                       base::DiagnosticSink& sink);
  /// Gives the folder back; removes it if it was made in vain and nothing was put into it.
  ~RunFolder();
  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&&) = delete;
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  RunFolder() = default;

  std::filesystem::path path_;
  int fd_ = -1;
  bool made_ = false;
};

}  // namespace parallax::harness
