// Keys of YAML that is half typed, for completion and hover.
//
// A YAML parser stops at the first error, and while a key is typed there is one. Indentation tells
// the nesting all the same: a key belongs to the nearest line above that is indented less. Inside
// of brackets (`{x: [0, 1]}`), which may go over several lines, nesting is that of the brackets; a
// line that is indented no more than the bracket's key ends them, as YAML demands. Linear in the
// text.

#include "tools/lsp/yaml_outline.h"

#include <algorithm>
#include <cstdint>

namespace parallax::tools::lsp {
namespace {

class OutlineReader {
 public:
  explicit OutlineReader(std::string_view text) : text_(text) {}

  std::vector<YamlNode> read() {
    while (at_ < text_.size()) read_line();
    return std::move(nodes_);
  }

 private:
  /// A block that later lines may belong to.
  struct Block {
    std::size_t indent;
    bool is_element;
    std::size_t node;
  };

  char peek(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\n';
  }
  bool ends_word(std::size_t at) const {
    return at >= text_.size() || text_[at] == ' ' || text_[at] == '\n' || text_[at] == '\r';
  }
  std::size_t line_end() const { return std::min(text_.find('\n', at_), text_.size()); }
  void leave_line() { at_ = line_end() + 1; }

  std::optional<std::size_t> innermost() const {
    return blocks_.empty() ? std::nullopt : std::optional(blocks_.back().node);
  }

  std::size_t add(std::size_t begin, std::size_t end, std::size_t value,
                  std::optional<std::size_t> parent, bool is_element) {
    auto name = is_element ? std::string_view() : text_.substr(begin, end - begin);
    if (name.size() > 1 && (name.front() == '"' || name.front() == '\'') &&
        name.back() == name.front()) {
      name = name.substr(1, name.size() - 2);
    }
    nodes_.push_back({std::string(name), begin, end, value, value, parent});
    return nodes_.size() - 1;
  }

  /// The end of the key that begins here, a colon that a blank follows. None: there is no key.
  std::optional<std::size_t> key_end(bool in_brackets) const {
    if (peek() == '"' || peek() == '\'') {
      const auto close = text_.find(peek(), at_ + 1);
      if (close == std::string_view::npos || close > line_end()) return std::nullopt;
      return close + 1 < text_.size() && text_[close + 1] == ':' ? std::optional(close + 1)
                                                                 : std::nullopt;
    }
    for (auto i = at_; i < line_end(); ++i) {
      const char c = text_[i];
      if (c == ':' && (ends_word(i + 1) || (in_brackets && text_[i + 1] == ','))) return i;
      if (c == '#' && i > at_ && text_[i - 1] == ' ') return std::nullopt;
      if (in_brackets
              ? std::string_view(",[]{}").find(c) != std::string_view::npos
              : i == at_ && std::string_view("[]{}#&*!|>%@`").find(c) != std::string_view::npos) {
        return std::nullopt;
      }
    }
    return std::nullopt;
  }

  void read_line() {
    const auto begin = at_;
    while (peek() == ' ') ++at_;
    if (peek() == '\n' || peek() == '\r' || peek() == '#') return leave_line();
    // `- - key: value`: elements of lists, and then the rest of the line.
    while (peek() == '-' && ends_word(at_ + 1)) {
      const auto indent = at_ - begin;
      while (!blocks_.empty() && (blocks_.back().indent > indent ||
                                  (blocks_.back().indent == indent && blocks_.back().is_element))) {
        blocks_.pop_back();
      }
      blocks_.push_back({indent, true, add(at_, at_ + 1, at_ + 1, innermost(), true)});
      ++at_;
      while (peek() == ' ') ++at_;
      nodes_.back().value_end = line_end();
    }
    const auto indent = at_ - begin;
    const auto end = key_end(false);
    if (end) {
      while (!blocks_.empty() && blocks_.back().indent >= indent) blocks_.pop_back();
      blocks_.push_back({indent, false, add(at_, *end, *end + 1, innermost(), false)});
      at_ = *end + 1;
      while (peek() == ' ') ++at_;
    }
    read_value(indent);
  }

  void read_value(std::size_t indent) {
    const auto parent = innermost();
    if (peek() == '{' || peek() == '[') {
      read_brackets(indent, parent);
    } else if (peek() == '|' || peek() == '>') {
      // Lines of text: all that are indented more than the block.
      const auto least = blocks_.empty() ? 0 : blocks_.back().indent;
      leave_line();
      while (at_ < text_.size()) {
        std::size_t blanks = 0;
        while (peek(blanks) == ' ') ++blanks;
        if (peek(blanks) != '\n' && blanks <= least) break;
        leave_line();
      }
      if (parent) nodes_[*parent].value_end = std::min(at_, text_.size());
      return;
    } else if (peek() == '"' || peek() == '\'') {
      skip_quoted();
    }
    if (parent) nodes_[*parent].value_end = std::max(line_end(), nodes_[*parent].value_end);
    leave_line();
  }

  /// A text in quotes, which may go over lines; one that is not closed ends at the end of its line.
  void skip_quoted() {
    const char quote = peek();
    for (auto i = at_ + 1; i < text_.size(); ++i) {
      if (text_[i] == '\\' && quote == '"') {
        ++i;
      } else if (text_[i] == quote) {
        at_ = i + 1;
        return;
      }
    }
    at_ = line_end();
  }

  /// Brackets up to their end, or up to a line that cannot be inside of them.
  void read_brackets(std::size_t indent, std::optional<std::size_t> parent) {
    struct Bracket {
      bool is_map;
      std::optional<std::size_t> parent;
    };
    std::vector<Bracket> open;
    auto owner = parent;       // of the next bracket: the key in front of it
    bool expects_key = false;  // behind `{` or `,`
    while (at_ < text_.size()) {
      const char c = peek();
      if (c == '\n') {
        std::size_t blanks = 1;
        while (peek(blanks) == ' ') ++blanks;
        const bool is_blank = at_ + blanks >= text_.size() || peek(blanks) == '\n';
        const bool is_close = peek(blanks) == '}' || peek(blanks) == ']';
        if (!is_blank && !is_close && blanks - 1 <= indent) return;
        at_ += is_blank ? 1 : blanks;
      } else if (c == ' ' || c == '\r' || c == '\t') {
        ++at_;
      } else if (c == '#' && at_ > 0 && (text_[at_ - 1] == ' ' || text_[at_ - 1] == '\n')) {
        at_ = line_end();
      } else if (c == '{' || c == '[') {
        if (!open.empty() && !open.back().is_map)
          owner = add(at_, at_, at_, open.back().parent, true);
        open.push_back({c == '{', owner});
        expects_key = c == '{';
        ++at_;
      } else if (c == '}' || c == ']') {
        if (open.back().parent) nodes_[*open.back().parent].value_end = at_ + 1;
        open.pop_back();
        ++at_;
        expects_key = false;
        if (open.empty()) return;
      } else if (c == ',') {
        ++at_;
        expects_key = open.back().is_map;
      } else if (const auto end = expects_key ? key_end(true) : std::nullopt) {
        owner = add(at_, *end, *end + 1, open.back().parent, false);
        at_ = *end + 1;
        expects_key = false;
      } else {
        skip_word();
        if (owner && open.back().is_map) nodes_[*owner].value_end = at_;
        expects_key = false;
      }
    }
  }

  /// A value inside of brackets.
  void skip_word() {
    if (peek() == '"' || peek() == '\'') return skip_quoted();
    while (at_ < text_.size() && std::string_view(",[]{}\n").find(peek()) == std::string_view::npos)
      ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<Block> blocks_;
  std::vector<YamlNode> nodes_;
};

}  // namespace

std::vector<YamlNode> yaml_outline(std::string_view text) { return OutlineReader(text).read(); }

std::vector<std::string> yaml_path(const std::vector<YamlNode>& nodes, std::size_t node) {
  std::vector<std::string> out;
  for (std::optional<std::size_t> at = node; at; at = nodes[*at].parent)
    out.push_back(nodes[*at].name);
  std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace parallax::tools::lsp
