#pragma once

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/lisp/lisp_reader.h"

namespace parallax::compiler {

inline constexpr std::size_t kMaxPlanPackages = 1000;
inline constexpr std::size_t kMaxInheritedNames = 1000000;

/// Gives every symbol that some file defines as a function or a global the key of the definition
/// that it means: by `defpackage`, `in-package`, `export` and prefixes, as in Common Lisp. A name
/// that one package defines is its own key; others read `package::name`. Packages that no file
/// defines are left to the robot: a symbol with such a prefix means no definition of the plan.
/// Without `defpackage` and `in-package` prefixes mean nothing. Reports CPL060.
base::Status resolve_packages(LispText& text, base::DiagnosticSink& sink);

}  // namespace parallax::compiler
