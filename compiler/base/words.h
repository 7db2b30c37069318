#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::base {

/// A count with its noun: counted(1, "run", "runs") is "1 run".
std::string counted(std::int64_t count, std::string_view one, std::string_view many);

/// The same for a noun whose plural only adds an s.
std::string counted(std::int64_t count, std::string_view noun);

/// The word that agrees with a count: agreed(n, "is", "are").
inline std::string_view agreed(std::int64_t count, std::string_view one, std::string_view many) {
  return count == 1 ? one : many;
}

/// Names as an enumeration: "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& names, std::string_view last = "and");

/// The text in one line: white space becomes single blanks, and none stand at its ends.
std::string one_line(std::string_view text);

}  // namespace parallax::base
