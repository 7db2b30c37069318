#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string_view>
#include <system_error>

namespace parallax::base {

/// The number that the whole of `text` is: digits, for signed types with a `-` before them if need
/// be; no blanks, no plus sign. None if it is something else or `Integer` cannot hold it.
template <std::integral Integer>
std::optional<Integer> whole_number(std::string_view text, int base = 10) {
  Integer number{};
  const auto* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number, base);
  if (error != std::errc() || stop != end) return std::nullopt;
  return number;
}

}  // namespace parallax::base
