#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::tools {

/// Recorded costs, each in units of the reference work measured in the same run.
struct Bounds {
  std::map<std::string, double> questions;  // processor time by the row's name
  std::map<std::string, double> builds;     // the same for builds from nothing
};

/// A question is slow from this many times its recorded ratio on.
inline constexpr double kSlowQuestion = 1.5;
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
  kFaster,    // under the recorded ratio by the same factor: the record is out of date
  kLonger,    // told, no failure (builds only)
  kExceeded,  // a failure
  kUnknown,   // no ratio is recorded: a failure, since nothing guards the row
};

/// Compares one measured ratio with the recorded one.
BoundVerdict judge_question(double ratio, std::optional<double> recorded);
BoundVerdict judge_build(double ratio, std::optional<double> recorded);

/// One line: name, ratio, recorded ratio, verdict in words.
std::string verdict_line(const std::string& name, double ratio, std::optional<double> recorded,
                         BoundVerdict verdict);

/// The ratio recorded under `name`, if any.
std::optional<double> recorded_ratio(const std::map<std::string, double>& ratios,
                                     const std::string& name);

}  // namespace parallax::tools
