#include "tests/tools/schema/json_schema.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

namespace parallax::test {
namespace {

using nlohmann::json;

constexpr std::string_view kLocal = "#/";

bool is_of_type(const json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "null") return value.is_null();
  if (type == "number") return value.is_number();
  return type == "integer" && value.is_number_integer();
}

/// Calls `visit` with every schema and its place.
void for_each_schema(const json& schema, const std::string& place,
                     const std::function<void(const json&, const std::string&)>& visit) {
  if (!schema.is_object()) return;
  visit(schema, place);
  for (const auto* map : {"properties", "$defs"}) {
    if (!schema.contains(map)) continue;
    for (const auto& [key, part] : schema.at(map).items()) {
      for_each_schema(part, place + '/' + map + '/' + key, visit);
    }
  }
  for (const auto* list : {"anyOf"}) {
    if (!schema.contains(list)) continue;
    for (std::size_t i = 0; i < schema.at(list).size(); ++i) {
      for_each_schema(schema.at(list)[i], place + '/' + list + '/' + std::to_string(i), visit);
    }
  }
  for (const auto* one : {"items", "additionalProperties", "propertyNames"}) {
    if (schema.contains(one)) for_each_schema(schema.at(one), place + '/' + one, visit);
  }
}

}  // namespace

JsonSchema::JsonSchema(json schema) : schema_(std::move(schema)) {}

const json& JsonSchema::resolved(const json& schema, std::string& place) const {
  const auto* at = &schema;
  while (at->contains("$ref")) {
    place = at->at("$ref").get<std::string>();
    at = &schema_.at(json::json_pointer(place.substr(1)));
  }
  return *at;
}

std::vector<std::string> JsonSchema::faults() const {
  static const std::set<std::string> kKeywords = {"$schema",
                                                  "$id",
                                                  "$defs",
                                                  "$ref",
                                                  "title",
                                                  "version",
                                                  "type",
                                                  "enum",
                                                  "const",
                                                  "properties",
                                                  "required",
                                                  "additionalProperties",
                                                  "items",
                                                  "minItems",
                                                  "maxItems",
                                                  "anyOf",
                                                  "description",
                                                  "propertyNames",
                                                  "minimum",
                                                  "maximum",
                                                  "pattern",
                                                  "exclusiveMinimum",
                                                  "exclusiveMaximum",
                                                  "default"};
  std::vector<std::string> out;
  for_each_schema(schema_, "#", [&](const json& schema, const std::string& place) {
    for (const auto& [key, value] : schema.items()) {
      if (!kKeywords.contains(key)) out.push_back(place + ": unknown keyword " + key);
    }
    if (schema.contains("properties") && !schema.contains("additionalProperties")) {
      out.push_back(place + ": an object that is open");
    }
    for (const auto& name : schema.value("required", json::array())) {
      if (!schema.at("properties").contains(name.get<std::string>())) {
        out.push_back(place + ": requires " + name.get<std::string>() + ", which it does not name");
      }
    }
    if (schema.contains("$ref")) {
      const auto name = schema.at("$ref").get<std::string>();
      if (!name.starts_with(kLocal) || !schema_.contains(json::json_pointer(name.substr(1)))) {
        out.push_back(place + ": refers to nothing: " + name);
      }
    }
  });
  return out;
}

void JsonSchema::judge_object(const json& schema, const std::string& place, const json& value,
                              const std::string& where, Judgement& out) const {
  for (const auto& name : schema.value("required", json::array())) {
    if (!value.contains(name.get<std::string>())) {
      out.errors.push_back(where + ": lacks `" + name.get<std::string>() + '`');
    }
  }
  const auto properties = schema.value("properties", json::object());
  for (const auto& [key, member] : value.items()) {
    const json* part = nullptr;
    std::string part_place;
    if (properties.contains(key)) {
      part = &properties.at(key);
      part_place = place + "/properties/" + key;
      out.seen.insert(part_place);
    } else if (schema.contains("additionalProperties")) {
      part = &schema.at("additionalProperties");
      part_place = place + "/additionalProperties";
    }
    if (part == nullptr) continue;
    if (part->is_boolean()) {
      if (!part->get<bool>()) out.errors.push_back(where + ": has the unknown key `" + key + '`');
      continue;
    }
    auto judged = judge(*part, part_place, member, where + '/' + key);
    out.seen.merge(judged.seen);
    out.errors.insert(out.errors.end(), judged.errors.begin(), judged.errors.end());
  }
}

JsonSchema::Judgement JsonSchema::judge(const json& given, std::string place, const json& value,
                                        const std::string& where) const {
  const auto& schema = resolved(given, place);
  Judgement out;
  const auto refuse = [&](const std::string& why) { out.errors.push_back(where + ": " + why); };
  if (schema.contains("const") && value != schema.at("const")) {
    refuse(value.dump() + " is not " + schema.at("const").dump());
  }
  if (schema.contains("enum")) {
    const auto& words = schema.at("enum");
    if (std::find(words.begin(), words.end(), value) == words.end()) {
      refuse(value.dump() + " is none of " + words.dump());
    }
  }
  if (schema.contains("type")) {
    const auto& type = schema.at("type");
    const auto types = type.is_array() ? type.get<std::vector<std::string>>()
                                       : std::vector{type.get<std::string>()};
    if (std::none_of(types.begin(), types.end(),
                     [&](const auto& one) { return is_of_type(value, one); })) {
      refuse(value.dump().substr(0, 60) + " is no " + type.dump());
    }
  }
  if (value.is_array()) {
    if (value.size() < schema.value("minItems", std::size_t{0})) refuse("too few items");
    if (value.size() > schema.value("maxItems", value.size())) refuse("too many items");
    for (std::size_t i = 0; schema.contains("items") && i < value.size(); ++i) {
      auto judged =
          judge(schema.at("items"), place + "/items", value[i], where + '/' + std::to_string(i));
      out.seen.merge(judged.seen);
      out.errors.insert(out.errors.end(), judged.errors.begin(), judged.errors.end());
    }
  }
  if (value.is_object()) judge_object(schema, place, value, where, out);
  if (schema.contains("anyOf")) {
    std::optional<Judgement> best;
    for (std::size_t i = 0; i < schema.at("anyOf").size(); ++i) {
      auto one = judge(schema.at("anyOf")[i], place + "/anyOf/" + std::to_string(i), value, where);
      if (!best || one.errors.size() < best->errors.size()) best = std::move(one);
    }
    out.seen.merge(best->seen);
    out.errors.insert(out.errors.end(), best->errors.begin(), best->errors.end());
  }
  return out;
}

std::vector<std::string> JsonSchema::errors(const json& document) {
  auto judged = judge(schema_, "#", document, "");
  if (judged.errors.empty()) seen_.merge(judged.seen);
  return judged.errors;
}

std::vector<std::string> JsonSchema::unseen() const {
  std::vector<std::string> out;
  for_each_schema(schema_, "#", [&](const json& schema, const std::string& place) {
    if (!schema.contains("properties")) return;
    for (const auto& [key, part] : schema.at("properties").items()) {
      const auto name = place + "/properties/" + key;
      if (!seen_.contains(name)) out.push_back(name);
    }
  });
  return out;
}

}  // namespace parallax::test
