#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace parallax::compiler {

/// A cursor over the text of one plan file. Byte offsets; never past the end.
class LispCursor {
 public:
  explicit LispCursor(std::string_view text) : text_(text) {}
  bool at_end() const { return position_ >= text_.size(); }
  std::uint32_t position() const { return static_cast<std::uint32_t>(position_); }
  /// The byte `ahead` of the cursor; 0 beyond the end.
  char peek(std::size_t ahead = 0) const {
    return position_ + ahead < text_.size() ? text_[position_ + ahead] : '\0';
  }
  char take() { return text_[position_++]; }
  void skip(std::size_t count) { position_ = std::min(position_ + count, text_.size()); }
  std::string_view since(std::uint32_t begin) const {
    return text_.substr(begin, position_ - begin);
  }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
};

/// A symbol-like token: letters outside |bars| folded to lower case, escapes resolved.
struct LispToken {
  std::string text;
  bool escaped = false;           // some part was written in |bars| or after a backslash
  bool unterminated = false;      // the text ended inside |bars|
  bool ends_with_colon = false;   // unescaped
  std::int64_t first_colon = -1;  // index in `text` of the first unescaped colon
  std::int64_t colons = 0;        // number of unescaped colons
};

/// Ends a token: blanks and ( ) " ' ; ` ,
bool is_lisp_delimiter(char c);

/// A token up to the next delimiter.
LispToken scan_token(LispCursor& cursor);

/// Skips blanks, `; comments` and nested `#| comments |#`. False if a block comment does not end;
/// `begin` is then its place.
bool skip_blanks(LispCursor& cursor, std::uint32_t& begin);

}  // namespace parallax::compiler
