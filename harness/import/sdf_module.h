#pragma once

#include "harness/import/import.h"

namespace parallax::harness {

// libsdformat sets itself up for some 15 ms wherever it is linked, as long as all of a small
// question takes. So its reader is a module that is loaded where a world in SDF is read.

inline constexpr const char* kSdfModule = "parallax_sdf.so";
inline constexpr const char* kSdfReader = "parallax_read_sdf";

/// The module's only function. False, and nothing done, where `version` is not its own.
using ReadSdf = bool(const char* version, const ImportInput& input, ImportedWorld& world);

}  // namespace parallax::harness
