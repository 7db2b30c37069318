#pragma once

#include <chrono>
#include <cstdint>

namespace parallax::base {

using SteadyClock = std::chrono::steady_clock;

/// The longest time that is waited for. Longer ones are this long: a hundred years from now the
/// clock's 64-bit count of nanoseconds still does not overflow.
inline constexpr double kLongestWait_s = 100.0 * 365.0 * 86400.0;

/// Converts seconds to a duration of the clock. Saturates at 0 and at kLongestWait_s; NaN is 0.
/// The one place where seconds of files, options and simulators become ticks.
SteadyClock::duration clock_duration(double seconds);

/// The time point `seconds` from now, saturated as by clock_duration.
SteadyClock::time_point from_now(double seconds);

/// The milliseconds that are left until `deadline`, rounded up, at most `most_ms`; 0 if it has
/// passed. For poll(), whose limit is an int.
int milliseconds_left(SteadyClock::time_point deadline, int most_ms);

/// Whole seconds, rounded up, for limits of the system that are counted in seconds. Saturates as
/// clock_duration does.
std::uint64_t whole_seconds(double seconds);

/// Converts MiB to bytes, for limits of the system. Saturates at 2^62.
std::uint64_t bytes_of_mb(std::int64_t mb);

}  // namespace parallax::base
