#include "compiler/base/clock_time.h"

#include <doctest/doctest.h>

#include <climits>
#include <limits>
#include <vector>

namespace parallax::base {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST_CASE("seconds of any size are a duration that does not overflow, in their order") {
  const std::vector<double> rising = {-kInfinity, -1e300,  -1.0, 0.0,  1e-300, 1e-9,  0.5,
                                      1.0,        86400.0, 3e9,  1e10, 3e13,   1e300, kInfinity};
  auto before = SteadyClock::duration::zero();
  for (const double seconds : rising) {
    CAPTURE(seconds);
    const auto duration = clock_duration(seconds);
    CHECK(duration >= before);
    CHECK(SteadyClock::now() + duration >= SteadyClock::now() - std::chrono::hours(1));
    before = duration;
  }
  CHECK(clock_duration(kNaN) == SteadyClock::duration::zero());
  CHECK(clock_duration(1.5) == std::chrono::milliseconds(1500));
  CHECK(clock_duration(kInfinity) == clock_duration(kLongestWait_s));
}

TEST_CASE("a deadline that is very far is not over, and none waits longer than poll can") {
  for (const double seconds : {1e9, 1e10, 3e13, 1e300, kInfinity}) {
    CAPTURE(seconds);
    const auto deadline = from_now(seconds);
    CHECK(deadline > SteadyClock::now());
    CHECK(milliseconds_left(deadline, 100) == 100);
    CHECK(milliseconds_left(deadline, INT_MAX) == INT_MAX);
  }
  CHECK(milliseconds_left(SteadyClock::now() - std::chrono::hours(1), 100) == 0);
  CHECK(milliseconds_left(SteadyClock::time_point::min(), 100) == 0);
  CHECK(milliseconds_left(SteadyClock::now() + std::chrono::hours(1), -5) == 0);
  // The time left is rounded up, so that poll() waits out the last fraction of a millisecond
  // instead of being called again and again.
  CHECK(milliseconds_left(SteadyClock::now() + std::chrono::hours(1), 7) == 7);
}

TEST_CASE("limits of the system are whole and bounded") {
  CHECK(whole_seconds(0.001) == 1);
  CHECK(whole_seconds(2.0) == 2);
  CHECK(whole_seconds(-3.0) == 0);
  CHECK(whole_seconds(kNaN) == 0);
  CHECK(whole_seconds(kInfinity) + 1 > whole_seconds(86400.0));
  CHECK(bytes_of_mb(16) == 16U << 20U);
  CHECK(bytes_of_mb(-1) == 0);
  CHECK(bytes_of_mb(INT64_MAX) == std::uint64_t{1} << 62U);
}

}  // namespace
}  // namespace parallax::base
