#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/fuzz/old_encoder.h"
#include "tests/fuzz/old_tree.h"

namespace parallax::test {

/// An atom's text: `h` HoldsAt, `e` Happens, `r` ReleasedAt with a timepoint, or a user predicate.
std::string timed_atom(char kind, std::int64_t t, const std::string& name);
std::string predicate_atom(const std::string& name);

/// Each once, in order of occurrence.
std::vector<std::string> atoms_in(const OldTree& formula);

/// The assignments of the atoms that occur, under which every formula is true, at most `limit`: by
/// trying, atom after atom.
OldAnswer old_models(const std::vector<OldTree>& formulas, std::size_t horizon, std::size_t limit);

}  // namespace parallax::test
