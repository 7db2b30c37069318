#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"

namespace parallax::base {

/// Which files a command may change that a file names, and not the user: those that really lie
/// (links resolved) below the current folder, or below the nearest folder above it that is a git
/// repository or holds kRootMarker. A journal names the scenario as it lay where the run was made,
/// which in a copied project is the original. docs/reference/trust.md.
class WriteGate {
 public:
  /// `allow_outside`: everything may be changed.
  explicit WriteGate(bool allow_outside);

  /// Admits what lies below the folder of a file that the user named, or below its repository.
  void admit_beside(const std::filesystem::path& file);

  bool admits(const std::filesystem::path& path) const;
  /// Reports kWriteOutside.
  Status check(const std::filesystem::path& path, DiagnosticSink& sink) const;

 private:
  bool is_open_;
  std::vector<std::filesystem::path> roots_;  // real paths
};

/// Holds an output that the user did not name against links: it must really lie below `folder`, and
/// nothing that is there already below it may be a link that leads out of `folder`. A folder that
/// came from elsewhere may have such links. `option` is what names the output, "--out". Reports
/// kOutputLeadsOut.
Status check_unnamed_output(const std::filesystem::path& path, const std::filesystem::path& folder,
                            std::string_view option, DiagnosticSink& sink);

}  // namespace parallax::base
