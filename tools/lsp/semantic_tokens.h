#pragma once

#include "tools/lsp/documents.h"

namespace parallax::tools::lsp {

/// The names of the kinds of tokens, by their numbers: the server's `legend`.
Json token_legend();

/// Result of `textDocument/semanticTokens/full`. Throws Refused.
Json semantic_tokens(Documents& documents, const Json& params);

}  // namespace parallax::tools::lsp
