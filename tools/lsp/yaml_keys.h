#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::tools::lsp {

/// A key of a YAML file and the values that it takes, by the schemas that the program publishes.
struct YamlKey {
  std::string name;
  std::string value;                 // "number, > 0", "one of `error`, `allowed`"
  std::string unit;                  // "m/s"; empty: none, or not known
  std::vector<std::string> choices;  // the words that the value can be
  bool is_number = false;            // or numbers
};

/// The schema of a file with these keys at its top: "scenario.yaml", "suite.yaml" and others.
std::string_view schema_of_keys(const std::vector<std::string>& top_keys);

/// The named keys that may stand below a path ("" for an element of a list), in the schema's order.
std::vector<YamlKey> keys_below(std::string_view schema, const std::vector<std::string>& path);

/// The key at the end of a path; none if the schema has none there.
std::optional<YamlKey> key_at_path(std::string_view schema, const std::vector<std::string>& path);

/// Does the key's name say its unit, as `mass_kg` does?
bool says_unit(std::string_view key);

}  // namespace parallax::tools::lsp
