#pragma once

#include <ctime>

namespace parallax::tools {

/// Processor time of this process: other work on the machine does not count.
class Stopwatch {
 public:
  /// Since the last call, or since it was made [ms].
  double lap_ms() {
    const auto now = std::clock();
    const auto lap = now - begin_;
    begin_ = now;
    return 1e3 * static_cast<double>(lap) / CLOCKS_PER_SEC;
  }

 private:
  std::clock_t begin_ = std::clock();
};

}  // namespace parallax::tools
