#pragma once

#include <string>

#include "tools/app/context.h"

namespace parallax::tools {

/// The canonical text of one file: one fact a line, sorted, for goldens and `git diff`. Models (.e)
/// are read alone: what they load need not exist. A usage error for other kinds of files.
base::Result<std::string> canonical_text_of(const std::string& path, Context& context);

}  // namespace parallax::tools
