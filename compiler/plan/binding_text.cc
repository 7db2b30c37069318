#include "compiler/plan/binding_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "compiler/base/codes/plans.h"

namespace parallax::compiler {
namespace {

bool starts_with_word(std::string_view text, std::string_view word) {
  return text.starts_with(word) &&
         (text.size() == word.size() || base::is_space(text[word.size()]));
}

bool starts_entry(std::string_view text) {
  return starts_with_word(text, "motion") || starts_with_word(text, "action") ||
         starts_with_word(text, "query") || starts_with_word(text, "object") ||
         starts_with_word(text, "goal");
}

/// `;` opens a comment, except where the table uses it to separate parts: behind other text and
/// before a word that starts the next part.
bool is_separator(std::string_view line_before, std::string_view after) {
  if (line_before.find_first_not_of(" \t") == std::string_view::npos) return false;
  const auto word = after.find_first_not_of(" \t");
  if (word == std::string_view::npos) return false;
  after.remove_prefix(word);
  return starts_entry(after) || starts_with_word(after, "else") || starts_with_word(after, "on") ||
         starts_with_word(after, "returns") || after.starts_with("ok:");
}

/// Characters of types, keys and failure classes.
bool is_binding_name(char c) {
  return !base::is_space(c) && std::string_view("()|=,;:@/").find(c) == std::string_view::npos;
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

std::size_t variable_length(std::string_view text) {
  if (text.empty() || text.front() != '?') return 0;
  std::size_t i = 1;
  while (i < text.size()) {
    const bool hyphen =
        text[i] == '-' && i + 1 < text.size() && base::is_name_character(text[i + 1]);
    if (!base::is_name_character(text[i]) && !hyphen) break;
    ++i;
  }
  return i == 1 ? 0 : i;
}

void BindingCursor::enter(std::size_t entry) {
  i_ = entry == kPreamble ? 0 : cleaned_.entries[entry];
  const auto next = entry + 1;  // of the preamble: the first
  end_ = next < entries() ? cleaned_.entries[next] : text().size();
}

std::string_view BindingCursor::peek_name() const {
  const auto left = rest();
  std::size_t length = 0;
  while (length < left.size() && is_binding_name(left[length]) &&
         !left.substr(length).starts_with("->")) {
    ++length;
  }
  return left.substr(0, length);
}

bool BindingCursor::take(std::string_view literal) {
  skip_blanks();
  if (!rest().starts_with(literal)) return false;
  i_ += literal.size();
  return true;
}

bool BindingCursor::take_word(std::string_view word) {
  skip_blanks();
  if (peek_name() != word) return false;
  i_ += word.size();
  return true;
}

bool BindingCursor::expected(std::string_view what) {
  skip_blanks();
  failed_ = true;
  auto stop = i_;
  while (stop < end_ && !base::is_space(text()[stop]) && stop - i_ < 40) ++stop;
  const auto found = at_end() ? std::string("the end of the entry")
                              : fmt::format("`{}`", rest().substr(0, stop - i_));
  sink_.error(codes::kBindingSyntax, range(i_, stop), what, found);
  return false;
}

bool BindingCursor::name(std::string_view what, std::string& out) {
  skip_blanks();
  const auto word = peek_name();
  if (word.empty() || word.front() == '?') return expected(what);
  out = word;
  i_ += word.size();
  return true;
}

bool BindingCursor::symbol(std::string_view what, std::string& package, std::string& out) {
  if (!name(what, out)) return false;
  if (!rest().starts_with(":")) return true;
  package = std::move(out);
  i_ += rest().starts_with("::") ? 2 : 1;
  if (peek_name().empty()) return expected(what);
  return name(what, out);
}

bool BindingCursor::types(std::vector<std::string>& out) {
  do {
    std::string package;  // types are compared without it
    std::string type;
    if (!symbol("the name of a type", package, type)) return false;
    out.push_back(std::move(type));
  } while (take("|"));
  return true;
}

bool BindingCursor::variable(std::string& out) {
  skip_blanks();
  const auto length = variable_length(rest());
  if (length == 0) return expected("a variable such as `?o`");
  out = rest().substr(0, length);
  i_ += length;
  return true;
}

bool BindingCursor::variables(std::vector<std::string>& out) {
  if (!take("(")) return true;
  while (!take(")")) {
    std::string one;
    if (!variable(one)) return false;
    out.push_back(std::move(one));
    take(",");
  }
  return true;
}

}  // namespace parallax::compiler
