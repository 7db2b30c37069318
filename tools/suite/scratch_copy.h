#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "compiler/base/diagnostic.h"

namespace parallax::tools {

/// The texts that a suite reads, by the absolute names that they are read under.
using SuiteTexts = std::map<std::string, std::string>;

/// Copies of all files of a suite, in a folder of their own, in the same relative places as the
/// originals. Only the copies are ever written.
class ScratchCopy {
 public:
  /// `folder` must be new. Reports what cannot be written.
  static base::Result<ScratchCopy> make(const SuiteTexts& texts,
                                        const std::filesystem::path& folder,
                                        base::DiagnosticSink& sink);

  const std::filesystem::path& folder() const { return folder_; }
  /// The folder that contains all originals.
  const std::filesystem::path& root() const { return root_; }
  /// The copy of a file of the suite; any other file stays where it is.
  std::filesystem::path place_of(const std::string& name) const;
  /// Writes another text to the copies of a file, including those under its other names (links).
  base::Status write(const std::string& name, const std::string& text,
                     base::DiagnosticSink& sink) const;
  /// Restores the text of the original.
  base::Status restore(const std::string& name, base::DiagnosticSink& sink) const;

 private:
  struct Copy {
    std::filesystem::path target, original;  // where the original really lies
    std::string text;
  };
  std::filesystem::path folder_, root_;
  std::map<std::string, Copy> copies_;  // by absolute name
};

}  // namespace parallax::tools
