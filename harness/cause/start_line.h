#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/word_table.h"

namespace parallax::harness {

/// The result of a simulation from a start, with respect to a discrepancy.
enum class StartVerdict : std::uint8_t {
  kFails,      // it happens there, too
  kClean,      // the simulation gets past it as the model says
  kOtherwise,  // it goes wrong earlier, or in another way
  kNoStart,    // the simulator does not take the start, or was lost
};
inline constexpr auto kStartVerdictWords =
    base::word_table<StartVerdict>("fails", "clean", "otherwise", "no-start");
constexpr std::string_view to_string(StartVerdict verdict) {
  return kStartVerdictWords.of(verdict);
}

/// Values of the parameters of a start, in a fixed order.
using StartPoint = std::vector<double>;

/// A parameter of the start, with the values that starts are drawn from.
struct CellParameter {
  std::string name;
  double lower = 0.0, upper = 0.0;
  double width() const { return upper - lower; }
  double middle() const { return lower + 0.5 * (upper - lower); }
  friend bool operator==(const CellParameter&, const CellParameter&) = default;
};

/// Simulates starts, in parallel if it can. Fewer answers than starts: it ended behind these, by
/// its budget or because it was stopped, and is not asked again.
using StartProbe = std::function<std::vector<StartVerdict>(const std::vector<StartPoint>&)>;

/// Two values of one parameter, both simulated: it fails at one and not at the other.
struct BorderBracket {
  std::size_t parameter = 0;
  double fails = 0.0, other = 0.0;
  StartVerdict beyond = StartVerdict::kClean;  // at `other`; not kFails, not kNoStart
  double tolerance = 0.0;
  /// The value between them that is no start, where that ended the search.
  std::optional<double> no_start;
  double width() const { return fails > other ? fails - other : other - fails; }
  /// Narrow enough, or as narrow as numbers can be.
  bool is_narrow() const;
  friend bool operator==(const BorderBracket&, const BorderBracket&) = default;
};

/// Halves each bracket, all in step, until it is as narrow as its tolerance; the other parameters
/// stay as in `base`. What is between two ends has been simulated nowhere else: a bracket holds an
/// odd number of borders, and more than one only where the verdict changes back. False if the
/// probe ended before.
bool narrow(std::vector<BorderBracket>& brackets, const StartPoint& base, const StartProbe& probe);

/// The role of a parameter in the failure of a start.
enum class ParameterRole : std::uint8_t {
  kOpen,         // not asked: the probe ended before
  kIndifferent,  // in the middle of the cell it fails as well
  kDecides,      // moving it, and nothing else, to the middle ends it
  kNoStart,      // with it in the middle there is no simulation that would tell
};
inline constexpr auto kParameterRoleWords =
    base::word_table<ParameterRole>("open", "indifferent", "decides", "no-start");
constexpr std::string_view to_string(ParameterRole role) { return kParameterRoleWords.of(role); }

/// A failing start, as near to the middle of its cell as whole moves of single parameters take it.
struct ShrunkStart {
  StartPoint start;                    // it fails
  std::vector<ParameterRole> roles;    // by parameter
  std::optional<StartVerdict> middle;  // of the middle of the cell; none: not asked
  std::vector<BorderBracket> borders;  // of those that decide, from `start` towards the middle
  bool finished = false;               // the probe did not end before
};

/// Moves one parameter after the other to the middle of the cell and leaves it there where it fails
/// as before; again, until none of those left can be moved alone. If the middle itself fails, all
/// of them are moved at once. Then looks for the border of each that decides. `failing` is known to
/// fail. `tolerances` by parameter. Cost: parameters * (moves that fail late + 1) and
/// log2(width / tolerance) for each border.
ShrunkStart shrink_start(const std::vector<CellParameter>& cell, StartPoint failing,
                         const std::vector<double>& tolerances, const StartProbe& probe);

/// One parameter over its whole range, the others as in a failing start.
struct LineScan {
  struct Point {
    double value = 0.0;
    StartVerdict verdict = StartVerdict::kNoStart;
    friend bool operator==(const Point&, const Point&) = default;
  };
  std::vector<Point> points;           // by value, before any bracket was narrowed
  std::vector<BorderBracket> borders;  // between neighbours of which one fails
  bool finished = false;
};
/// Probes `points` (two or more) values from end to end, evenly spaced, then narrows each change.
LineScan scan_line(const CellParameter& range, std::size_t parameter, const StartPoint& failing,
                   std::int64_t points, double tolerance, const StartProbe& probe);

}  // namespace parallax::harness
