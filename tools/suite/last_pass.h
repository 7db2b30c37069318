#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/suite/scratch_copy.h"
#include "tools/suite/suite_case.h"

namespace parallax::tools {

/// What a case read when it passed for the last time.
struct LastPass {
  std::string program;     // program_hash() of then
  std::string definition;  // of the case in its manifest, hashed
  SuiteTexts texts;
};

/// The texts of the last pass of each case, a file each in a folder. What fails now is held against
/// them.
class LastPasses {
 public:
  explicit LastPasses(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Keeps the files of a case that passes, provided that they are still what it read, are texts
  /// and no more than some megabytes; else, and where it cannot be written, what is known of the
  /// case is forgotten. Safe from several threads for different cases.
  void keep(const SuiteCase& one, const CaseResult& result) const;
  std::optional<LastPass> find(const SuiteCase& one) const;

  static std::string definition_of(const SuiteCase& one);

 private:
  std::filesystem::path folder_of(const SuiteCase& one) const;

  std::filesystem::path folder_;
};

}  // namespace parallax::tools
