#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::tools {

/// A published JSON Schema: of a document that a command prints, or of a YAML file.
struct SchemaInfo {
  std::string name;     // "traces", "scenario.yaml"
  std::string version;  // "1.0": the second number counts additions, the first everything else
  std::string title;
};

/// The names of all schemas, sorted. Reads none of them.
std::vector<std::string> schema_names();

/// All schemas, by name.
std::vector<SchemaInfo> schema_list();

/// The name of the schema of a command's documents: commands that only print a text share one.
std::string schema_name(std::string_view command);

/// The schema as one document of JSON Schema 2020-12, with all definitions that it refers to. None
/// if there is no schema of this name.
std::optional<std::string> schema_text(std::string_view name);

}  // namespace parallax::tools
