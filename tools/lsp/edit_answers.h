#pragma once

#include "tools/lsp/documents.h"
#include "tools/lsp/publishing.h"

namespace parallax::tools::lsp {

// Results of the requests `textDocument/...` that change texts. Throw Refused.

/// `prepareRename`: the range of the name there, or null.
Json name_range(Documents& documents, const Json& params);
/// Renames everywhere, unless the compiler then finds errors that were not there: a name that is
/// taken, or none at all.
Json rename(Documents& documents, const Json& params);
Json formatting(Documents& documents, const Json& params);
/// `codeAction`: the mends that messages in the range name, where a change of text is one.
Json actions(Documents& documents, const Publishing& published, const Json& params);

}  // namespace parallax::tools::lsp
