#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>

namespace parallax::tools::lsp {

// Kinds of files by their names, and the lines and words of their texts.

inline bool is_yaml(std::string_view path) {
  return path.ends_with(".yaml") || path.ends_with(".yml");
}
inline bool is_model(std::string_view path) { return path.ends_with(".e"); }
inline bool is_table(std::string_view path) { return path.ends_with(".bind"); }
inline bool is_plan(std::string_view path) { return path.ends_with(".lisp"); }

inline bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The line in front of its comment: `;` in models and tables, `#` in YAML.
std::string_view without_comment(std::string_view line, bool yaml);

/// The comment lines directly above an offset, without their signs.
std::string comment_above(std::string_view text, std::size_t offset);

/// Calls `each(offset, line)` for every line, without its end.
template <typename Each>
void each_line(std::string_view text, const Each& each) {
  for (std::size_t at = 0; at <= text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    each(at, text.substr(at, end - at));
    at = end + 1;
  }
}

}  // namespace parallax::tools::lsp
