#pragma once

#include <span>
#include <string_view>

namespace parallax::tools {

/// A file of tools/schema/documents, as it was when the program was built.
struct SchemaFile {
  std::string_view path;  // "traces.json"
  std::string_view text;
};

std::span<const SchemaFile> schema_files();

}  // namespace parallax::tools
