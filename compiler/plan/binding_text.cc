#include "compiler/plan/binding_text.h"

#include <algorithm>

#include "compiler/base/ascii.h"

namespace parallax::compiler {
namespace {

bool starts_with_word(std::string_view text, std::string_view word) {
  return text.starts_with(word) &&
         (text.size() == word.size() || base::is_space(text[word.size()]));
}

bool starts_entry(std::string_view text) {
  return starts_with_word(text, "motion") || starts_with_word(text, "action") ||
         starts_with_word(text, "query") || starts_with_word(text, "object");
}

/// `;` opens a comment, except where the table uses it to separate parts: behind other text and
/// before a word that starts the next part.
bool is_separator(std::string_view line_before, std::string_view after) {
  if (line_before.find_first_not_of(" \t") == std::string_view::npos) return false;
  const auto word = after.find_first_not_of(" \t");
  if (word == std::string_view::npos) return false;
  after.remove_prefix(word);
  return starts_entry(after) || starts_with_word(after, "else") ||
         starts_with_word(after, "returns") || after.starts_with("ok:");
}

}  // namespace

BindingText clean_binding(std::string_view file) {
  BindingText out{std::string(file), {}};
  std::size_t begin = 0;
  while (begin < file.size()) {
    const auto end = std::min(file.find('\n', begin), file.size());
    bool part_start = true;  // at the start of a line or behind a separator
    for (std::size_t i = begin; i < end; ++i) {
      const auto rest = file.substr(i, end - i);
      if (rest.front() == ';') {
        if (!is_separator(file.substr(begin, i - begin), rest.substr(1))) {
          std::fill(out.text.begin() + static_cast<std::ptrdiff_t>(i),
                    out.text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
          break;
        }
        out.text[i] = ' ';
        part_start = true;
      } else if (!base::is_space(rest.front())) {
        if (part_start && starts_entry(rest)) out.entries.push_back(i);
        part_start = false;
      }
    }
    begin = end + 1;
  }
  return out;
}

}  // namespace parallax::compiler
