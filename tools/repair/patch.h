#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compiler/base/source_file.h"
#include "compiler/repair/axiom_form.h"

namespace parallax::tools {

/// The changed text of one file.
struct ChangedFile {
  std::string name;  // as the files have it
  std::string before, after;
};
/// The files that the changes touch, in order of their names.
std::vector<ChangedFile> changed_files(const base::SourceFiles& files,
                                       const std::vector<compiler::TextChange>& changes);

/// The folder that the names in a patch of these files are relative to, seen from `folder`, an
/// absolute path: ".", if they all lie below it, as `git apply` requires; else the top of the git
/// repository that has them all, as "../.."; else "/".
std::string patch_folder(const std::vector<ChangedFile>& files,
                         const std::filesystem::path& folder);

/// A unified diff with three lines of context, as `git apply` and `patch -p1` read it in the
/// `patch_folder`.
std::string unified_diff(const std::vector<ChangedFile>& files,
                         const std::filesystem::path& folder);

/// Both for the current folder.
std::string patch_folder(const std::vector<ChangedFile>& files);
std::string patch_from_here(const std::vector<ChangedFile>& files);

/// A sentence that says where to apply it; empty: in the current folder.
std::string patch_place_words(const std::vector<ChangedFile>& files);

}  // namespace parallax::tools
