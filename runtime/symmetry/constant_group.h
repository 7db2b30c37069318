#pragma once

#include <gmpxx.h>

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/symmetry/permutation_check.h"

namespace parallax::runtime {

/// A group of permutations of constants as a chain of stabilizers (Sims 1970): a level has the
/// permutations that fix the bases of the levels before it. Every permutation of the group is in
/// exactly one way a product of one from each level.
struct ConstantGroup {
  struct Level {
    std::uint32_t base = 0;
    std::vector<std::uint32_t> orbit;  // of the base under this level's group; the base first
    /// By place in the orbit: a permutation of this level's group that takes the base there. Empty:
    /// exchanging the two does.
    std::vector<ConstantMap> to;
  };

  /// The constants that some permutation moves; everywhere here a constant is its number in this
  /// list.
  std::vector<std::string> constants;
  std::vector<Level> levels;
  /// By level, as far as levels have permutations, and once more: by constant, the number of its
  /// orbit under that level's group. The levels after these exchange within the last orbits.
  std::vector<std::vector<std::uint32_t>> orbits;
  /// Pair of `one`, which is in the orbit of a level's base, and another constant. Pairs that
  /// permutations of the level take to each other have one kind. The largest kind of each orbit is
  /// left out.
  struct Tie {
    std::uint32_t one, other, kind;
  };
  std::vector<std::vector<Tie>> ties;  // by level, as far as levels have permutations

  mpz_class order() const;
};

/// Input of group_of, in numbers of all constants.
struct GroupParts {
  std::vector<ConstantGroup::Level> levels;
  std::vector<std::uint32_t> bases;  // bases of the levels, and other constants that do not move
  std::vector<std::vector<std::uint32_t>> orbits;  // by level and once more; none: only exchanges
};

/// The group of the levels, followed by all exchanges of constants of one set that are no bases.
ConstantGroup group_of(const std::vector<std::string>& constants,
                       const std::vector<std::uint32_t>& set_of, const GroupParts& parts);

}  // namespace parallax::runtime
