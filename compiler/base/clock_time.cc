#include "compiler/base/clock_time.h"

#include <algorithm>
#include <cmath>

namespace parallax::base {
namespace {

double saturated(double seconds) {
  return seconds > 0.0 ? std::min(seconds, kLongestWait_s) : 0.0;  // NaN is not above 0
}

}  // namespace

SteadyClock::duration clock_duration(double seconds) {
  return std::chrono::duration_cast<SteadyClock::duration>(
      std::chrono::duration<double>(saturated(seconds)));
}

SteadyClock::time_point from_now(double seconds) {
  return SteadyClock::now() + clock_duration(seconds);
}

int milliseconds_left(SteadyClock::time_point deadline, int most_ms) {
  const auto now = SteadyClock::now();
  if (deadline <= now) return 0;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - now);
  return static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, std::max(most_ms, 0)));
}

std::uint64_t whole_seconds(double seconds) {
  return static_cast<std::uint64_t>(std::ceil(saturated(seconds)));
}

std::uint64_t bytes_of_mb(std::int64_t mb) {
  constexpr std::int64_t kMost = std::int64_t{1} << 42;
  return static_cast<std::uint64_t>(std::clamp<std::int64_t>(mb, 0, kMost)) << 20U;
}

}  // namespace parallax::base
