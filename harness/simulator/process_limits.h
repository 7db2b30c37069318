#pragma once

#include <cstdint>

namespace parallax::harness {

/// Limits of a simulator in a process of its own, by the clock of the wall.
struct ProcessLimits {
  double hello_timeout_s = 60.0;
  double reset_timeout_s = 10.0;
  double act_timeout_s = 0.0;  // 0: 5 s + simulated limit / min_real_time_factor
  double observe_timeout_s = 2.0;
  double close_timeout_s = 2.0;
  double min_real_time_factor = 1.0;
  std::int64_t memory_mb = 4096;  // of all its processes; 0: no bound
};

}  // namespace parallax::harness
