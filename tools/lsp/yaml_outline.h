#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::tools::lsp {

/// A key of a YAML text, or an element of a list.
struct YamlNode {
  std::string name;                   // without quotes; empty: an element
  std::size_t begin = 0, end = 0;     // of the key, or of the sign in front of the element
  std::size_t value_begin = 0;        // behind the colon or sign
  std::size_t value_end = 0;          // of what stands on the same line or inside of the brackets
  std::optional<std::size_t> parent;  // among the nodes; none: the top
};

/// The keys and elements of a text, by their places. Half-typed texts have those that can be told
/// by indentation and brackets: this is no check, which the scenario's reader makes.
std::vector<YamlNode> yaml_outline(std::string_view text);

/// The names from the top to a node; "" for an element.
std::vector<std::string> yaml_path(const std::vector<YamlNode>& nodes, std::size_t node);

}  // namespace parallax::tools::lsp
