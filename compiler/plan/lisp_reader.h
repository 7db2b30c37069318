#pragma once

#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/plan/lisp_data.h"

namespace parallax::compiler {

/// The data of one plan file and its top-level forms in order.
struct LispText {
  base::FileId file;
  LispData data;
  std::vector<DatumId> forms;
};

inline constexpr std::size_t kMaxLispDepth = 1000;
inline constexpr std::size_t kMaxLispData = 1000000;

/// Reads s-expressions in the subset of docs/plan_language.md, section "Reading". Symbols are
/// folded to lower case; `#+f` and `#-f` see the one feature `seecer`; `#.`, `#S`, `#A` and other
/// reader macros are CPL002, everything else that cannot be read is CPL001, several per run.
/// Linear in the length of the text; nothing recursive, so nesting costs no stack.
base::Result<LispText> read_lisp(const base::SourceFiles& files, base::FileId file,
                                 base::DiagnosticSink& sink);

}  // namespace parallax::compiler
