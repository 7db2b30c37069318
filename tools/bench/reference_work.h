#pragma once

#include <cstdint>

namespace parallax::tools {

/// Fixed work of about 0.3 s that is the unit of `--check`: sorting, hashing, text, and clauses
/// visited in random order, as the program does. It shares no code with the program, so a change
/// there never changes the unit. Returns a checksum that depends on all of it.
std::uint64_t reference_work();

}  // namespace parallax::tools
