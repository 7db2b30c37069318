#pragma once

#include <string>

#include "harness/world/world_spec.h"

namespace parallax::harness {

/// Sixteen hexadecimal digits of what the engine makes of a small fixed world: boxes that fall on
/// each other and tumble, a ball that rolls off, a pendulum. Two processors, or two builds of the
/// engine, whose digits differ simulate differently. "none" where the engine is not available.
std::string engine_digits(EngineKind engine);

}  // namespace parallax::harness
