#include "tools/schema/schema.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "compiler/base/contract.h"
#include "compiler/base/json.h"
#include "tools/schema/schema_files.h"

namespace parallax::tools {
namespace {

using SchemaJson = nlohmann::ordered_json;

constexpr std::string_view kSchemaDefinitions = "common";  // the file of what several schemas use
constexpr std::string_view kSchemaReference = "#/$defs/";
constexpr std::string_view kSchemaEnding = ".json";

std::optional<SchemaJson> schema_file(std::string_view name) {
  for (const auto& file : schema_files()) {
    if (file.path.substr(0, file.path.size() - kSchemaEnding.size()) != name) continue;
    auto json = base::parse_ordered_json(file.text);
    PARALLAX_REQUIRE(json.is_object(), "a schema in tools/schema/documents is a JSON object");
    return json;
  }
  return std::nullopt;
}

/// Adds the names of all definitions that `schema` refers to, and those that these refer to.
void find_references(const SchemaJson& schema, const SchemaJson& definitions,
                     std::set<std::string>& names) {
  std::vector<const SchemaJson*> open = {&schema};
  while (!open.empty()) {
    const auto& json = *open.back();
    open.pop_back();
    if (json.is_structured()) {
      for (const auto& part : json) open.push_back(&part);
    }
    const auto* reference = base::json_member(json, "$ref");
    if (reference == nullptr || !reference->is_string()) continue;
    const auto name = reference->get<std::string>().substr(kSchemaReference.size());
    PARALLAX_REQUIRE(definitions.contains(name), "a schema refers to what common.json defines");
    if (names.insert(name).second) open.push_back(&definitions.at(name));
  }
}

}  // namespace

std::vector<std::string> schema_names() {
  std::vector<std::string> out;
  for (const auto& file : schema_files()) {
    out.emplace_back(file.path.substr(0, file.path.size() - kSchemaEnding.size()));
    if (out.back() == kSchemaDefinitions) out.pop_back();
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<SchemaInfo> schema_list() {
  std::vector<SchemaInfo> out;
  for (auto& name : schema_names()) {
    const auto json = schema_file(name).value();
    const auto text = [&](const char* key) { return json.at(key).get<std::string>(); };
    out.push_back({std::move(name), text("version"), text("title")});
  }
  return out;
}

std::string schema_name(std::string_view command) {
  for (const std::string_view text : {"help", "man", "completion"}) {
    if (command == text) return "text";
  }
  return std::string(command);
}

std::optional<std::string> schema_text(std::string_view name) {
  if (name == kSchemaDefinitions) return std::nullopt;
  const auto schema = schema_file(name);
  if (!schema) return std::nullopt;
  const auto definitions = schema_file(kSchemaDefinitions).value();
  SchemaJson out = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                    {"$id", "urn:parallax:schema:" + std::string(name) + ":" +
                                schema->at("version").get<std::string>()}};
  for (const auto& [key, value] : schema->items()) out[key] = value;
  std::set<std::string> names;
  find_references(*schema, definitions, names);
  for (const auto& used : names) out["$defs"][used] = definitions.at(used);
  return base::json_text(out, 2) + '\n';
}

}  // namespace parallax::tools
