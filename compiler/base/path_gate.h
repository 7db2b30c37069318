#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"

namespace parallax::base {

/// An empty file of this name makes its folder the root of what lies in it.
inline constexpr std::string_view kRootMarker = ".parallax-root";

/// Which files a file may name: those that really lie (links resolved) below the folder of a file
/// that the user named, or below the nearest folder above it that holds kRootMarker. A marker in a
/// folder that others can write to does not count. Home folders and `/` are never roots as a whole:
/// of them only the visible files that lie directly there are admitted. docs/reference/trust.md.
class PathGate {
 public:
  /// `files`, if given, outlives the gate and notes every place where a marker was looked for.
  explicit PathGate(bool allow_outside = false, SourceFiles* files = nullptr)
      : is_open_(allow_outside), files_(files) {}

  /// Admits the paths that the file may name.
  void admit_beside(const std::filesystem::path& file) { admit_from(file.parent_path()); }
  /// The same for texts in `folder`.
  void admit_from(const std::filesystem::path& folder);
  /// Admits all that lies in a folder that the user named as such.
  void admit_folder(const std::filesystem::path& folder);
  /// Admits what lies in the current folder, unless that is a home folder or `/`.
  void admit_current_folder();

  bool admits(const std::filesystem::path& path) const;
  /// Reports kLoadOutside at `place` for a path that is not admitted; it need not exist.
  Status check(const std::filesystem::path& path, const SourceRange& place,
               DiagnosticSink& sink) const;

 private:
  struct Root {
    std::filesystem::path folder;  // its real path
    bool whole = true;             // false: only the visible files directly in it
  };

  bool is_open_;
  SourceFiles* files_;
  std::vector<Root> roots_;
};

/// Does the folder hold a marker that counts?
bool is_marked_root(const std::filesystem::path& folder);

/// Where a path really leads, links resolved as far as it exists.
std::filesystem::path real_path(const std::filesystem::path& path);

/// Does `path` really lie in `folder` or below it?
bool lies_below(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace parallax::base
