#pragma once

#include <cstdint>

namespace parallax::compiler {

/// Bounds of the unrolling of a plan.
struct UnrollLimits {
  std::int64_t max_call_depth = 8;  // active calls of one function
  std::int64_t max_loop = 16;       // iterations of a loop that nothing static ends
  std::int64_t max_locations = 20'000;
  std::int64_t max_steps = 5'000'000;  // and list elements, over all paths
  std::int64_t location_samples = 0;   // further solutions of a location before there is none
};

}  // namespace parallax::compiler
