#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace parallax::test {

/// A fresh folder that holds a copy of scenarios/two_regions and goes with the fixture. The program
/// runs in it.
class CliFixture {
 public:
  CliFixture();
  ~CliFixture();
  CliFixture(const CliFixture&) = delete;
  CliFixture& operator=(const CliFixture&) = delete;

  /// `parallax ARGS...` in the folder.
  ProcessResult parallax(std::vector<std::string> arguments, ProcessOptions options = {}) const;
  /// Path of the program.
  static std::string program();
  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  /// Replaces the one occurrence of `from` in a file.
  void replace(const std::string& name, const std::string& from, const std::string& to) const;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

/// The text without the values of every `"timing":{...}`.
std::string without_timing(std::string text);

/// Every regular file below the folder, path and content.
std::vector<std::pair<std::string, std::string>> files_below(const std::filesystem::path& folder);

}  // namespace parallax::test
