#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "compiler/builtins/plan_builtins.h"

namespace parallax::compiler {

// Values that only the robot knows: its position, answers of tf, the time. They are terms: the
// function and its arguments. A value computed from them is a term again; code that needs a number,
// a truth value or a region from one reports that there is none.

ValueId unknown_value(std::string_view function, std::span<const ValueId> arguments,
                      ValueStore& values);
/// Result of the built-in if one of its arguments is such a value; none if the built-in computes it
/// as usual. Parts that a constructor was given come back as they are.
std::optional<BuiltinResult> with_unknown(std::string_view builtin,
                                          std::span<const ValueId> arguments, ValueStore& values);
/// The robot's function that the value comes from.
std::string_view origin_of_unknown(const ValueStore& values, ValueId id);
/// Does the function of this name return such values?
bool is_unknown_source(std::string_view name);
/// A time that only the robot knows; it may be the stamp of a pose that is known.
bool is_robot_time(const Value& value);
/// A constant or global of the robot's own packages: `pi`, `*fixed-frame*`, `*transformer*` ...
std::optional<ValueId> robot_global(std::string_view name, ValueStore& values);

}  // namespace parallax::compiler
