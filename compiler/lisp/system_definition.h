#pragma once

#include <filesystem>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/base/source_file.h"

namespace parallax::compiler {

/// A file that a system definition names, in relation to its folder.
struct SystemFile {
  std::filesystem::path path;
  base::SourceRange place;  // of the name
};

inline constexpr std::size_t kMaxPlanFiles = 1000;

/// The Lisp files of the one `defsystem` in an `.asd` file in the order in which ASDF loads them:
/// as written, what a component depends on before it, `:serial t` obeyed. The file is read as data
/// and never run: a form other than `defsystem`, `in-package` and `defpackage`, and an option whose
/// value is code, are CPL061. So are circles, components that are named twice or nowhere, and more
/// than kMaxPlanFiles components.
base::Result<std::vector<SystemFile>> read_system(const base::SourceFiles& files, base::FileId file,
                                                  base::DiagnosticSink& sink);

}  // namespace parallax::compiler
