#pragma once

#include <algorithm>
#include <string_view>

namespace parallax::base {

// Kinds of ASCII characters, whatever the locale; no other byte is of any kind.

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
constexpr bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
constexpr bool is_letter(char c) { return is_lower(c) || is_upper(c); }
/// Letters, digits and `_`: what names are made of.
constexpr bool is_name_character(char c) { return is_letter(c) || is_digit(c) || c == '_'; }
/// Blank, tab, carriage return, line feed: what separates words.
constexpr bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

constexpr char to_lower(char c) { return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c; }
constexpr char to_upper(char c) { return is_lower(c) ? static_cast<char>(c - 'a' + 'A') : c; }

/// A letter or `_`, then letters, digits and `_`.
constexpr bool is_identifier(std::string_view text) {
  return !text.empty() && !is_digit(text.front()) &&
         std::all_of(text.begin(), text.end(), is_name_character);
}

/// Are there only characters that separate words?
constexpr bool is_all_space(std::string_view text) {
  return std::all_of(text.begin(), text.end(), is_space);
}

}  // namespace parallax::base
