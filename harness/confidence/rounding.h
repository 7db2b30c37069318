#pragma once

// Figures of a probability for people. A bound is rounded away from what it bounds, so that the
// printed interval contains the computed one, and a confidence is rounded down. Digits follow the
// distance to 0 or 1, whichever is nearer: 99.96 % is not printed as 100 %, nor 0.04 % as 0.

#include <cstdint>
#include <string>

namespace parallax::harness {

enum class Round : std::uint8_t {
  kDown,     // lower bounds
  kUp,       // upper bounds
  kNearest,  // estimates, which bound nothing
};

/// `probability` in per cent without the sign: "48.3", "0.0125", "99.96". Three significant digits
/// of the distance to the nearer of 0 and 100.
std::string percent_figure(double probability, Round round);

/// The same with a blank and the sign: "5 %", "48.3 %".
std::string percent_up(double probability);
std::string percent_down(double probability);
std::string percent_about(double probability);

/// Bounds of a probability as an interval: "21.2 to 40.1 %".
std::string percent_interval(double lower, double upper);

/// A confidence in per cent, rounded down: "99 %", "99.9999 %". Six significant digits of the
/// error, so that a level that was typed reads as it was typed.
std::string level_text(double confidence);

/// A small probability as a number with three significant digits: "1.24e-05".
std::string small_figure(double probability, Round round);

/// `value` with `decimals` decimals, or as the shortest number that reads back to it beyond 15.
std::string decimal_figure(double value, int decimals, Round round);

/// A p-value with two significant digits, rounded up: "p = 0.0013".
std::string p_text(double p_value);

}  // namespace parallax::harness
