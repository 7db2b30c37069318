#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/suite/suite_case.h"

namespace parallax::tools {

/// Current hashes of files and folders, each computed once. Not thread-safe.
class InputHashes {
 public:
  /// SHA-256 of a file's bytes; of a folder, of its sorted entries' names; of a marker of a root
  /// that does not count, and where nothing is: empty. Where links lead elsewhere follows the
  /// digits, as links may be refused.
  const std::string& of(const std::string& path);
  /// Are all these files unchanged?
  bool unchanged(const std::vector<InputFile>& inputs);

 private:
  std::map<std::string, std::string> known_;
};

/// SHA-256 of this program's file, of those of the libraries that it has loaded, and of its modules
/// with theirs, which children load. It identifies the program that made a result.
const std::string& program_hash();

}  // namespace parallax::tools
