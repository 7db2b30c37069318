// Keys of scenarios, worlds, suites, gates and ledgers, with types, ranges and units.
//
// The schemas of `parallax schema` know which keys there are: a path of keys is followed through
// `properties`, `additionalProperties` and `items`, in all alternatives of `anyOf` at once. Units
// are the ends of names (`radius_m`); the few keys without one are lengths and angles of regions,
// bodies and sampled variables.

#include "tools/lsp/yaml_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "compiler/base/json.h"
#include "harness/region/state_mapping.h"
#include "tools/schema/schema.h"

namespace parallax::tools::lsp {
namespace {

using SchemaNode = nlohmann::ordered_json;
using SchemaNodes = std::vector<const SchemaNode*>;

struct UnitOfEnd {
  std::string_view end, unit;
};

// An end that another one ends with comes first.
constexpr std::array<UnitOfEnd, 15> kUnits = {{
    {"_m_s2", "m/s^2"},
    {"_rad_s", "rad/s"},
    {"_n_s_m", "N s/m"},
    {"_nm_rad", "N m/rad"},
    {"_nm_s", "N m s"},
    {"_kg_m2", "kg m^2"},
    {"_m_s", "m/s"},
    {"_n_m", "N/m"},
    {"_nm", "N m"},
    {"_kg", "kg"},
    {"_rad", "rad"},
    {"_mb", "MB"},
    {"_n", "N"},
    {"_s", "s"},
    {"_m", "m"},
}};

const std::map<std::string, SchemaNode, std::less<>>& yaml_schemas() {
  static const auto kSchemas = [] {
    std::map<std::string, SchemaNode, std::less<>> out;
    for (const auto& name : schema_names()) {
      if (name.ends_with(".yaml"))
        out.emplace(name, base::parse_ordered_json(schema_text(name).value()));
    }
    return out;
  }();
  return kSchemas;
}

/// The schema and all alternatives in it, with references followed.
void add_alternatives(const SchemaNode& root, const SchemaNode& node, SchemaNodes& out) {
  if (const auto* reference = base::json_member(node, "$ref")) {
    constexpr std::string_view kPrefix = "#/$defs/";
    const auto name = reference->get<std::string>().substr(kPrefix.size());
    add_alternatives(root, root.at("$defs").at(name), out);
  }
  out.push_back(&node);
  if (const auto* any = base::json_member(node, "anyOf")) {
    for (const auto& one : *any) add_alternatives(root, one, out);
  }
}

SchemaNodes step_into(const SchemaNode& root, const SchemaNodes& from, const std::string& name) {
  SchemaNodes out;
  for (const auto* node : from) {
    const SchemaNode* next = nullptr;
    if (name.empty()) {
      next = base::json_member(*node, "items");
    } else {
      const auto* properties = base::json_member(*node, "properties");
      if (properties != nullptr) next = base::json_member(*properties, name.c_str());
      if (next == nullptr) next = base::json_member(*node, "additionalProperties");
    }
    if (next != nullptr && next->is_object()) add_alternatives(root, *next, out);
  }
  return out;
}

SchemaNodes nodes_at(const SchemaNode& root, const std::vector<std::string>& path) {
  SchemaNodes nodes;
  add_alternatives(root, root, nodes);
  for (const auto& name : path) nodes = step_into(root, nodes, name);
  return nodes;
}

bool is_numeric(const SchemaNode& type) {
  if (type.is_array()) return std::any_of(type.begin(), type.end(), is_numeric);
  return type == "number" || type == "integer";
}

std::string range_words(const SchemaNode& node) {
  std::string out;
  constexpr std::array<std::pair<const char*, std::string_view>, 4> kBounds = {
      {{"exclusiveMinimum", ">"}, {"minimum", ">="}, {"exclusiveMaximum", "<"}, {"maximum", "<="}}};
  for (const auto& [bound, sign] : kBounds) {
    if (const auto* value = base::json_member(node, bound))
      out += fmt::format(", {} {}", sign, value->dump());
  }
  return out;
}

/// One alternative in words; empty where it only collects others.
std::string value_words(const SchemaNode& root, const SchemaNode& node) {
  if (const auto* choices = base::json_member(node, "enum")) {
    std::string out;
    for (const auto& choice : *choices)
      out +=
          fmt::format("{}{}", out.empty() ? "" : " or ",
                      choice.is_string() ? "`" + choice.get<std::string>() + "`" : choice.dump());
    return out;
  }
  const auto* type = base::json_member(node, "type");
  if (type == nullptr) return {};
  if (type->is_array()) {
    std::string out;
    for (const auto& one : *type)
      out += fmt::format("{}{}", out.empty() ? "" : " or ", one.get<std::string>());
    return out;
  }
  const auto name = type->get<std::string>();
  if (name == "object") return "map";
  if (name == "string") return "text";
  if (name != "array") return name + range_words(node);
  std::string elements = "anything";
  if (const auto* items = base::json_member(node, "items"); items != nullptr) {
    SchemaNodes all;
    add_alternatives(root, *items, all);
    for (const auto* one : all) {
      auto words = value_words(root, *one);
      if (!words.empty()) {
        elements = std::move(words);
        break;
      }
    }
  }
  const auto* least = base::json_member(node, "minItems");
  const auto* most = base::json_member(node, "maxItems");
  if (least != nullptr && most != nullptr && *least == *most)
    return fmt::format("list of {}: {}", least->dump(), elements);
  return fmt::format("list: {}", elements);
}

bool holds_numbers(const SchemaNode& root, const SchemaNode& node) {
  const auto* type = base::json_member(node, "type");
  if (type == nullptr) return false;
  if (is_numeric(*type)) return true;
  const auto* items = base::json_member(node, "items");
  if (*type != "array" || items == nullptr) return false;
  SchemaNodes all;
  add_alternatives(root, *items, all);
  return std::any_of(all.begin(), all.end(),
                     [&](const auto* one) { return holds_numbers(root, *one); });
}

std::string unit_of(std::string_view key) {
  const auto* known = std::find_if(kUnits.begin(), kUnits.end(),
                                   [&](const auto& unit) { return key.ends_with(unit.end); });
  if (known != kUnits.end()) return std::string(known->unit);
  // Variables are named by body and coordinate: `box.x`.
  const auto dot = key.rfind('.');
  const auto last = dot == std::string_view::npos ? key : key.substr(dot + 1);
  if (last == "yaw" || harness::is_angle(key)) return "rad";
  const bool is_length = last == "x" || last == "y" || last == "z" || key == "bottom" ||
                         key == "polygon" || key == "hull";
  return is_length ? "m" : "";
}

YamlKey key_of_nodes(const SchemaNode& root, const std::string& name, const SchemaNodes& nodes) {
  YamlKey out{name, {}, {}, {}, false};
  std::vector<std::string> seen;
  for (const auto* node : nodes) {
    out.is_number = out.is_number || holds_numbers(root, *node);
    if (const auto* choices = base::json_member(*node, "enum")) {
      for (const auto& choice : *choices) {
        if (choice.is_string()) out.choices.push_back(choice.get<std::string>());
      }
    }
    if (const auto* type = base::json_member(*node, "type"); type != nullptr && *type == "boolean")
      out.choices.insert(out.choices.end(), {"true", "false"});
    auto words = value_words(root, *node);
    if (words.empty() || std::find(seen.begin(), seen.end(), words) != seen.end()) continue;
    out.value += (seen.empty() ? "" : "; or ") + words;
    seen.push_back(std::move(words));
  }
  if (out.is_number) out.unit = unit_of(name);
  return out;
}

}  // namespace

std::string_view schema_of_keys(const std::vector<std::string>& top_keys) {
  std::string_view best = "scenario.yaml";
  std::ptrdiff_t most = 0;
  const auto try_one = [&](std::string_view name) {
    const auto keys = keys_below(name, {});
    const auto known = std::count_if(top_keys.begin(), top_keys.end(), [&](const auto& top) {
      return std::any_of(keys.begin(), keys.end(),
                         [&](const auto& key) { return key.name == top; });
    });
    if (known <= most) return;
    most = known;
    best = name;
  };
  try_one("scenario.yaml");  // first, so that it wins where another has as many
  for (const auto& [name, schema] : yaml_schemas()) try_one(name);
  return best;
}

std::vector<YamlKey> keys_below(std::string_view schema, const std::vector<std::string>& path) {
  const auto& root = yaml_schemas().find(schema)->second;
  std::vector<YamlKey> out;
  const auto nodes = nodes_at(root, path);
  for (const auto* node : nodes) {
    const auto* properties = base::json_member(*node, "properties");
    if (properties == nullptr) continue;
    for (const auto& [name, unused] : properties->items()) {
      const bool is_there =
          std::any_of(out.begin(), out.end(), [&](const auto& key) { return key.name == name; });
      if (!is_there) out.push_back(key_of_nodes(root, name, step_into(root, nodes, name)));
    }
  }
  return out;
}

std::optional<YamlKey> key_at_path(std::string_view schema, const std::vector<std::string>& path) {
  if (path.empty() || path.back().empty()) return std::nullopt;
  const auto& root = yaml_schemas().find(schema)->second;
  const auto nodes = nodes_at(root, path);
  if (nodes.empty()) return std::nullopt;
  return key_of_nodes(root, path.back(), nodes);
}

bool says_unit(std::string_view key) {
  return std::any_of(kUnits.begin(), kUnits.end(),
                     [&](const auto& unit) { return key.ends_with(unit.end); });
}

}  // namespace parallax::tools::lsp
