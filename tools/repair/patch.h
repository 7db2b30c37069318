#pragma once

#include <string>
#include <string_view>
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

/// A unified diff with three lines of context, as `git apply` and `patch -p1` read it. Names below
/// `folder`, an absolute path, are told from there.
std::string unified_diff(const std::vector<ChangedFile>& files, const std::string& folder);

}  // namespace parallax::tools
