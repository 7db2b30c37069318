#pragma once

#include <filesystem>
#include <string>

namespace parallax::base {

/// A new folder among the temporary ones, for its owner alone, which goes with the object.
class TemporaryFolder {
 public:
  /// `purpose` is part of its name.
  explicit TemporaryFolder(const std::string& purpose);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Its real path; empty if none could be made.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace parallax::base
