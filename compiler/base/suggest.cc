// The name that somebody may have meant: the nearest by edit distance.
//
// The distance counts insertions, deletions, substitutions and exchanges of neighbours (Damerau
// 1964), by the usual table over prefixes, of which three rows are kept; letters that were
// exchanged are not edited again. A candidate is near if the distance is within the limit and at
// most half of the longer word; the first of the nearest is taken. Candidates whose length
// differs by more than the limit are not compared.
//
// Cost: the product of both lengths for each candidate compared.

#include "compiler/base/suggest.h"

#include <algorithm>
#include <vector>

#include "compiler/base/ascii.h"

namespace parallax::base {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    c = to_lower(c);
  }
  return out;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> before(width), above(width), row(width);
  for (std::size_t j = 0; j < width; ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j < width; ++j) {
      const std::size_t substitute = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, substitute});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    std::swap(before, above);
    std::swap(above, row);
  }
  return above[b.size()];
}

std::optional<std::string> nearest_name(std::string_view name,
                                        std::span<const std::string> candidates,
                                        std::size_t limit) {
  std::optional<std::string> best;
  std::size_t best_distance = limit + 1;
  const auto wanted = lower(name);
  for (const auto& candidate : candidates) {
    // A distance is at least the difference in length: do not compare a megabyte with a word.
    const auto longer = std::max(wanted.size(), candidate.size());
    const auto shorter = std::min(wanted.size(), candidate.size());
    if (longer - shorter > limit) continue;
    const auto distance = edit_distance(wanted, lower(candidate));
    // A word of two letters is not "near" every other word of two letters.
    if (distance < best_distance && distance * 2 <= longer) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace parallax::base
