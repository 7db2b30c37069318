#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/syntax/lexer.h"

namespace parallax::compiler {

/// The longest line that the layout makes where it has a choice, in bytes.
inline constexpr std::size_t kLayoutWidth = 100;

/// A token of one formula, its label and its period among them.
struct LayoutToken {
  Token token;
  std::string_view text;
  bool prefix = false;        // an operator in front of its operand
  bool quantifier = false;    // a `[` or `{`, or the bracket that closes it
  bool space_before = false;  // on one line
  std::uint32_t partner = 0;  // of a bracket: the other one
};

/// Works out what `tokens` need beyond text and kind. They are those of one formula without
/// syntax errors. Linear.
void prepare(std::vector<LayoutToken>& tokens);

/// The formula on one line where it fits into kLayoutWidth. Otherwise it is broken after the
/// quantifier and after the weakest connectives, level by level; what still does not fit is broken
/// inside its brackets. Depends on the tokens alone, so it is idempotent. No final newline.
/// Time and space: O(tokens), as breaking stops at a fixed depth.
std::string lay_out(const std::vector<LayoutToken>& tokens);

/// Tokens [begin, end) on one line.
std::string on_one_line(const std::vector<LayoutToken>& tokens, std::size_t begin, std::size_t end);

}  // namespace parallax::compiler
