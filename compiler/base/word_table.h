#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace parallax::base {

/// The words of an enum, at the positions of its values. Options, keys, help, readers and printing
/// take them from here. Literals: each ends with a null character.
template <typename Enum, std::size_t kCount>
struct WordTable : std::array<std::string_view, kCount> {
  constexpr std::string_view of(Enum value) const {
    return this->at(static_cast<std::size_t>(value));
  }
  /// The first value that has this word.
  constexpr std::optional<Enum> find(std::string_view word) const {
    const auto at = std::find(this->begin(), this->end(), word);
    if (at == this->end()) return std::nullopt;
    return static_cast<Enum>(at - this->begin());
  }
  /// Sets the value if a word is one of these.
  constexpr void take(std::string_view word, auto& value) const {
    if (const auto found = find(word)) value = *found;
  }
};

/// word_table<Execution>("open-loop", "closed-loop")
template <typename Enum, typename... Words>
constexpr WordTable<Enum, sizeof...(Words)> word_table(Words... words) {
  return {{std::string_view(words)...}};
}

}  // namespace parallax::base
