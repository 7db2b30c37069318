#pragma once

#include <string>

#include "tools/lsp/documents.h"

namespace parallax::tools::lsp {

/// Completion items at a place of a YAML text: the keys that may stand there and do not yet, or the
/// words that the value of the key there can be.
Json yaml_completion(std::string_view text, std::size_t offset);

/// The key at a place, its type, range and unit, as Markdown; empty if the schema knows none there.
std::string yaml_hover(std::string_view text, std::size_t offset);

/// Result of `textDocument/inlayHint`: units behind numbers of YAML whose keys do not say them.
/// Throws Refused.
Json unit_hints(Documents& documents, const Json& params);

}  // namespace parallax::tools::lsp
