#pragma once

#include <string>

#include "compiler/base/result.h"
#include "compiler/base/source_file.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// The text of an option (`--until`) as a text of its own among the files, so that it is parsed by
/// itself and messages point into it. kUsage if it says nothing: blanks and comments at most.
base::Result<base::SourceRange> formula_argument(const std::string& option, const std::string& text,
                                                 Context& context);

}  // namespace parallax::tools
