// Answers about keys of YAML. Where a key may be typed is found with a trial: a key is written at
// the place, and the outline tells what it would belong to.

#include "tools/lsp/yaml_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

#include "tools/lsp/file_text.h"
#include "tools/lsp/yaml_keys.h"
#include "tools/lsp/yaml_outline.h"

namespace parallax::tools::lsp {
namespace {

std::string_view schema_of_nodes(const std::vector<YamlNode>& nodes) {
  std::vector<std::string> top;
  for (const auto& node : nodes) {
    if (!node.parent && !node.name.empty()) top.push_back(node.name);
  }
  return schema_of_keys(top);
}

std::string words_of(const YamlKey& key) {
  return key.value + (key.unit.empty() ? "" : ", in " + key.unit);
}

bool in_key(char c) { return is_word(c) || c == '-' || c == '.'; }

/// The innermost key with its value around an offset.
std::optional<std::size_t> key_around(const std::vector<YamlNode>& nodes, std::size_t offset) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& node = nodes[i];
    if (!node.name.empty() && node.value_begin <= offset && offset <= node.value_end) found = i;
  }
  return found;
}

}  // namespace

Json yaml_completion(std::string_view text, std::size_t offset) {
  auto begin = std::min(offset, text.size()), end = begin;
  while (begin > 0 && in_key(text[begin - 1])) --begin;
  while (end < text.size() && in_key(text[end])) ++end;
  // A colon behind the word is there already.
  const bool is_key = text.substr(end).starts_with(':');
  const std::string trial =
      std::string(text.substr(0, begin)) + "?: " + std::string(text.substr(is_key ? end + 1 : end));
  const auto nodes = yaml_outline(trial);
  Json items = Json::array();
  constexpr int kProperty = 10, kEnumMember = 20;
  const auto tried = std::find_if(nodes.begin(), nodes.end(),
                                  [&](const auto& node) { return node.begin == begin; });
  if (tried != nodes.end() && tried->name == "?") {
    std::set<std::string> taken;
    for (const auto& node : nodes) {
      if (node.parent == tried->parent) taken.insert(node.name);
    }
    auto path = yaml_path(nodes, static_cast<std::size_t>(tried - nodes.begin()));
    path.pop_back();
    for (const auto& key : keys_below(schema_of_nodes(nodes), path)) {
      if (taken.contains(key.name)) continue;
      items.push_back({{"label", key.name},
                       {"kind", kProperty},
                       {"detail", words_of(key)},
                       {"insertText", is_key ? key.name : key.name + ": "}});
    }
    return items;
  }
  const auto around = key_around(nodes, begin);
  if (!around) return items;
  const auto key = key_at_path(schema_of_nodes(nodes), yaml_path(nodes, *around));
  if (!key) return items;
  for (const auto& choice : key->choices)
    items.push_back({{"label", choice}, {"kind", kEnumMember}, {"detail", key->name}});
  return items;
}

std::string yaml_hover(std::string_view text, std::size_t offset) {
  const auto nodes = yaml_outline(text);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].name.empty() || offset < nodes[i].begin || offset > nodes[i].end) continue;
    const auto key = key_at_path(schema_of_nodes(nodes), yaml_path(nodes, i));
    if (!key) return {};
    return fmt::format("`{}`: {}", key->name, words_of(*key));
  }
  return {};
}

Json unit_hints(Documents& documents, const Json& params) {
  const auto path = documents.asked_path(params);
  const auto& text = documents.text(path);
  const auto positions = documents.positions(path);
  const auto& range = member(params, "range");
  const auto from = positions.offset(place_of(member(range, "start"))),
             to = positions.offset(place_of(member(range, "end")));
  Json out = Json::array();
  if (!is_yaml(path)) return out;
  const auto nodes = yaml_outline(text);
  const auto schema = schema_of_nodes(nodes);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& node = nodes[i];
    if (node.name.empty() || says_unit(node.name) || node.value_end < from || node.begin > to)
      continue;
    const auto key = key_at_path(schema, yaml_path(nodes, i));
    if (!key || key->unit.empty()) continue;
    auto value = without_comment(
        std::string_view(text).substr(node.value_begin, node.value_end - node.value_begin), true);
    while (!value.empty() && (value.back() == ' ' || value.back() == '\r' || value.back() == '\n'))
      value.remove_suffix(1);
    if (value.find_first_of("0123456789") == std::string_view::npos) continue;
    out.push_back({{"position", json_of(positions.place(node.value_begin + value.size()))},
                   {"label", key->unit},
                   {"paddingLeft", true}});
  }
  return out;
}

}  // namespace parallax::tools::lsp
