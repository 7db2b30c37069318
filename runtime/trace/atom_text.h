#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::runtime {

/// `Move(Cat,Floor,On(a,b))`, taken apart: symbol and printed arguments.
struct AtomText {
  std::string symbol;
  std::vector<std::string> arguments;  // nested terms stay in one piece
  friend bool operator==(const AtomText&, const AtomText&) = default;
};

/// None for what is no printed atom: no parentheses, unbalanced ones, an empty argument.
std::optional<AtomText> split_atom(std::string_view atom);
std::string join_atom(const AtomText& parts);

}  // namespace parallax::runtime
