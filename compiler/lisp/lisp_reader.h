#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/lisp/lisp_data.h"

namespace parallax::compiler {

/// The data of a plan's files and their top-level forms in order.
struct LispText {
  base::FileId file;  // the first one
  LispData data;
  std::vector<DatumId> forms;
  /// "package::name" of each definition -> its key (resolve_packages); empty without packages.
  std::map<std::string, std::string, std::less<>> keys;
};

inline constexpr std::size_t kMaxLispDepth = 1000;
inline constexpr std::size_t kMaxLispData = 1000000;

/// Reads s-expressions in the subset of docs/reference/plan_language.md, section "Reading". Symbols
/// are folded to lower case; `#+f` and `#-f` see the one feature `seecer`; `#.`, `#S`, `#A` and
/// other reader macros are CPL002, everything else that cannot be read is CPL001, several per run.
/// Linear in the length of the text; nothing recursive, so nesting costs no stack.
base::Result<LispText> read_lisp(const base::SourceFiles& files, base::FileId file,
                                 base::DiagnosticSink& sink);
/// The same for several files, one behind the other; the limits are those of all together.
base::Result<LispText> read_lisp(const base::SourceFiles& files, std::span<const base::FileId> plan,
                                 base::DiagnosticSink& sink);

}  // namespace parallax::compiler
