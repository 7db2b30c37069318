#pragma once

#include "tools/lsp/documents.h"

namespace parallax::tools::lsp {

/// Result of `textDocument/codeLens`: the commands `parallax.run`, `parallax.traces` and
/// `parallax.explain` with a file as their argument, which the editor executes. Throws Refused.
Json lenses(Documents& documents, const Json& params);

}  // namespace parallax::tools::lsp
