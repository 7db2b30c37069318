#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace parallax::base {

/// Levenshtein distance of two byte strings, transpositions of neighbours counting once.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to `name`, at most `limit` edits away; the first of equals. Case-only
/// differences count as none, so `xMin` finds `xmin` before `xmax`.
std::optional<std::string> nearest_name(std::string_view name,
                                        std::span<const std::string> candidates,
                                        std::size_t limit = 2);

}  // namespace parallax::base
