#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::tools {

/// Recorded costs.
struct Bounds {
  std::map<std::string, double> questions;  // millions of instructions by the row's name
  std::map<std::string, double>
      builds;  // processor time of builds from nothing, in compilations of one file
};

/// A question is slow from this many times its recorded count on. Other versions of the system's
/// libraries change counts by some percent.
inline constexpr double kSlowQuestion = 1.25;
/// A build that is longer by more than this factor is told,
inline constexpr double kLongBuild = 1.1;
/// and by more than this one fails: single builds differ by some percent from run to run.
inline constexpr double kTooLongBuild = 1.25;

/// Reads `bounds.json`. On failure `error` says why.
std::optional<Bounds> parse_bounds(std::string_view text, std::string& error);
/// The same document, sorted by name, with three significant digits.
std::string to_json(const Bounds& bounds);

enum class BoundVerdict {
  kWithin,
  kFaster,    // under the recorded cost by the same factor: the record is out of date
  kLonger,    // told, no failure (builds only)
  kExceeded,  // a failure
  kUnknown,   // no cost is recorded: a failure, since nothing guards the row
};

/// Compares one measured cost with the recorded one.
BoundVerdict judge_question(double cost, std::optional<double> recorded);
BoundVerdict judge_build(double cost, std::optional<double> recorded);

/// One line: name, cost, recorded cost, verdict in words.
std::string verdict_line(const std::string& name, double cost, std::optional<double> recorded,
                         BoundVerdict verdict);

/// The cost recorded under `name`, if any.
std::optional<double> recorded_cost(const std::map<std::string, double>& costs,
                                    const std::string& name);

}  // namespace parallax::tools
