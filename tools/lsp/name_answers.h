#pragma once

#include "tools/lsp/documents.h"

namespace parallax::tools::lsp {

/// A place in an open document, and the declared name there.
struct AskedPlace {
  std::string path;
  std::size_t offset = 0;
  const DeclaredName* name = nullptr;  // null: none; lives until the documents change
};

/// The place that a request's `textDocument` and `position` say.
AskedPlace asked_place(Documents& documents, const Json& params);

// Results of the requests `textDocument/...` about names. Throw Refused.
Json hover(Documents& documents, const Json& params);
Json definition(Documents& documents, const Json& params);
Json references(Documents& documents, const Json& params);
Json highlights(Documents& documents, const Json& params);
Json completion(Documents& documents, const Json& params);
Json symbols(Documents& documents, const Json& params);

}  // namespace parallax::tools::lsp
