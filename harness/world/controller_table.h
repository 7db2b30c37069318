#pragma once

#include <cstdint>
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
};

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
