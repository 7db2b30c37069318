#pragma once

#include <span>
#include <string_view>

namespace parallax::harness {

/// One argument of a controller, as an action's `args` name it.
struct ArgumentSpec {
  std::string_view name;  // "target.x"
  std::string_view unit;  // "m", "s", "n"; "body" for the name of a free body
  bool required = false;
  double fallback = 0.0;  // unless required; NaN: see `help`
  bool positive = false;  // 0 and less are refused
  std::string_view help;
};

struct ControllerSpec {
  std::string_view name;  // "picking-up"
  std::span<const ArgumentSpec> arguments;
  std::string_view help;
};

/// All controllers of the built-in robot, sorted by name.
std::span<const ControllerSpec> controllers();

/// None if there is no controller `name`.
const ControllerSpec* find_controller(std::string_view name);

}  // namespace parallax::harness
