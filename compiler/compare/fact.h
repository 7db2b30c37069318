#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace parallax::compiler {

/// Where something stands, as messages print it; `line` is 0 where there is no place.
struct FactPlace {
  std::string file;
  std::uint32_t line = 0;
};
/// "door.e:12", or the file alone.
std::string to_string(const FactPlace& place);

enum class FactKind : std::uint8_t { kDeclaration, kAxiom };

/// One thing that a text says, in a form that does not depend on how it says it.
struct Fact {
  FactKind kind = FactKind::kDeclaration;
  std::string key;    // what it is about: equal keys with other texts are one declaration, changed
  std::string text;   // canonical, one line: facts with equal texts are the same
  std::string shown;  // as its author wrote it, on one line
  FactPlace place;
  /// The names in their order, in a fact that tells one.
  std::vector<std::string> sequence = {};
};

/// Difference of two lists of facts. Indices into the lists, in their order.
struct FactDifference {
  std::vector<std::size_t> removed;                          // indices into the old list
  std::vector<std::size_t> added;                            // indices into the new list
  std::vector<std::pair<std::size_t, std::size_t>> changed;  // old, new
  bool empty() const { return removed.empty() && added.empty() && changed.empty(); }
};

/// Two different texts, for people. Where they are too long to be shown whole, their common
/// beginning and end are left out (`...`) but for some words.
std::pair<std::string, std::string> changed_parts(const std::string& old_text,
                                                  const std::string& new_text);

/// Order and repetition say nothing. A removed and an added fact of one kind are a changed one if
/// they have the same key, or else if more than half of their words agree; the most similar pairs
/// are matched first. With more than kMaxMatched pairs to look at only equal keys are matched.
FactDifference compare_facts(std::span<const Fact> old_facts, std::span<const Fact> new_facts);
inline constexpr std::size_t kMaxMatched = 250'000;

/// The words, numbers and signs of a text.
std::vector<std::string_view> words_of(std::string_view text);

}  // namespace parallax::compiler
