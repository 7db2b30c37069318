#pragma once

#include <cstdint>

namespace parallax::harness {

/// The result of one run, for a test.
enum class RunResult : std::uint8_t { kClean, kFailure, kLost };

}  // namespace parallax::harness
