#include "compiler/lisp/lisp_token.h"

#include "compiler/base/ascii.h"

namespace parallax::compiler {
namespace {

bool skip_block_comment(LispCursor& cursor) {
  std::int64_t depth = 0;
  do {
    if (cursor.at_end()) return false;
    if (cursor.peek() == '#' && cursor.peek(1) == '|') {
      ++depth;
      cursor.skip(2);
    } else if (cursor.peek() == '|' && cursor.peek(1) == '#') {
      --depth;
      cursor.skip(2);
    } else {
      cursor.skip(1);
    }
  } while (depth > 0);
  return true;
}

/// The inside of |bars|, the cursor behind the opening one.
void scan_bars(LispCursor& cursor, LispToken& token) {
  token.escaped = true;
  while (!cursor.at_end()) {
    char c = cursor.take();
    if (c == '|') return;
    if (c == '\\' && !cursor.at_end()) c = cursor.take();
    token.text += c;
  }
  token.unterminated = true;
}

bool is_lisp_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

}  // namespace

bool is_lisp_delimiter(char c) {
  return is_lisp_blank(c) || std::string_view("()\"';`,").find(c) != std::string_view::npos;
}

LispToken scan_token(LispCursor& cursor) {
  LispToken token;
  while (!cursor.at_end() && !is_lisp_delimiter(cursor.peek())) {
    const char c = cursor.take();
    token.ends_with_colon = c == ':';
    if (c == '|') {
      scan_bars(cursor, token);
    } else if (c == '\\') {
      token.escaped = true;
      if (cursor.at_end()) {
        token.unterminated = true;
      } else {
        token.text += cursor.take();
      }
    } else {
      if (c == ':') {
        if (token.first_colon < 0) token.first_colon = static_cast<std::int64_t>(token.text.size());
        ++token.colons;
      }
      token.text += base::to_lower(c);
    }
  }
  return token;
}

bool skip_blanks(LispCursor& cursor, std::uint32_t& begin) {
  while (!cursor.at_end()) {
    if (is_lisp_blank(cursor.peek())) {
      cursor.skip(1);
    } else if (cursor.peek() == ';') {
      while (!cursor.at_end() && cursor.peek() != '\n') cursor.skip(1);
    } else if (cursor.peek() == '#' && cursor.peek(1) == '|') {
      begin = cursor.position();
      if (!skip_block_comment(cursor)) return false;
    } else {
      return true;
    }
  }
  return true;
}

}  // namespace parallax::compiler
