#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/suite/scratch_copy.h"
#include "tools/suite/suite_case.h"

namespace parallax::tools {

/// The files that a case read when it last passed.
struct LastPass {
  std::string program;     // program_hash() of then
  std::string definition;  // of the case in its manifest, hashed
  std::string files;       // files_hash() of what it read; may be empty
  SuiteTexts texts;
};

/// The texts of the last pass of each case, a file each in a folder. New failures are compared with
/// them. With another name it is the texts of other results, such as those of a history's last
/// line.
class LastPasses {
 public:
  explicit LastPasses(std::filesystem::path folder, std::string name = "passed")
      : folder_(std::move(folder)), name_(std::move(name)) {}

  /// Keeps the files of a case that passes, provided that they have not changed since it read them,
  /// are texts and have no more than some megabytes; otherwise, and where it cannot be written, the
  /// case's earlier files are removed. Safe from several threads for different cases.
  void keep(const SuiteCase& one, const CaseResult& result) const;
  /// The same whatever the result is.
  void keep_any(const SuiteCase& one, const CaseResult& result) const;
  std::optional<LastPass> find(const SuiteCase& one) const;

  static std::string definition_of(const SuiteCase& one);

 private:
  std::filesystem::path folder_of(const SuiteCase& one) const;

  std::filesystem::path folder_;
  std::string name_;
};

/// A hash of the contents of all files that were read, wherever the checkout lies; empty: of none.
std::string files_hash(const std::vector<InputFile>& inputs);

}  // namespace parallax::tools
