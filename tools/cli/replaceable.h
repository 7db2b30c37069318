#pragma once

#include <string>
#include <string_view>

#include "compiler/base/diagnostic.h"

namespace parallax::tools {

/// A file that a command makes anew: refuses one that is there and whose first bytes are not those
/// of an earlier output. Reports kOutputIsInput of what was read into `files`, kFileNotWritable,
/// and kNotARegularFile.
base::Status check_replaceable(const std::string& path, bool (*is_ours)(std::string_view head),
                               const base::SourceFiles& files, base::DiagnosticSink& sink);

/// An HTML page that this program made.
bool is_earlier_page(std::string_view head);

}  // namespace parallax::tools
