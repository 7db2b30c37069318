#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace parallax::harness {

/// One argument of a controller, as an action's `args` name it.
struct ArgumentSpec {
  std::string_view name;  // "target.x"
  /// "m", "s", "n"; or what a name stands for: "body" (a free one), "graspable" (with a `grasp`),
  /// "arm", "place", "drawer" (a slider with a handle and stops), "kind" (what detection looks
  /// for).
  std::string_view unit;
  bool required = false;
  double fallback = 0.0;  // unless required; NaN: see `help`
  bool positive = false;  // 0 and less are refused
  std::string_view help;
  /// Narrower bounds than those of the unit; NaN: none.
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  bool whole = false;             // 2.5 is refused
  std::string_view at_most = {};  // another argument that this one must not exceed
};

/// What a number given as this argument must lie within.
struct ArgumentBounds {
  double low = 0.0, high = 0.0;
  bool low_open = false;
};
ArgumentBounds bounds_of(const ArgumentSpec& argument);

/// Is the argument a name, not a number?
bool is_name(const ArgumentSpec& argument);

enum class RobotKind : std::uint8_t { kLine, kMobile };

struct ControllerSpec {
  std::string_view name;  // "picking-up"
  std::span<const ArgumentSpec> arguments;
  std::string_view help;
  RobotKind robot = RobotKind::kLine;  // whose it is
};

/// All controllers of the built-in robots, sorted by name.
std::span<const ControllerSpec> controllers();

/// None if there is no controller `name`.
const ControllerSpec* find_controller(std::string_view name);

}  // namespace parallax::harness
