#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "compiler/builtins/plan_builtins.h"

namespace parallax::compiler {

// Values that only the robot knows: where it stands, what tf says, when it is. They are terms: the
// function and its arguments. What is computed from them is a term again; whoever needs a number, a
// truth value or a region of one reports that there is none.

ValueId unknown_value(std::string_view function, std::span<const ValueId> arguments,
                      ValueStore& values);
/// What the built-in makes of arguments of which one is such a value; none: the built-in computes
/// it as ever. Parts that a constructor was given come back as they are.
std::optional<BuiltinResult> with_unknown(std::string_view builtin,
                                          std::span<const ValueId> arguments, ValueStore& values);
/// The function of the robot that the value comes from.
std::string_view origin_of_unknown(const ValueStore& values, ValueId id);
/// Is it one of the functions that such values come from?
bool is_unknown_source(std::string_view name);
/// A time that only the robot knows; it may be the stamp of a pose that is known.
bool is_robot_time(const Value& value);
/// A constant or global of the robot's own packages: `pi`, `*fixed-frame*`, `*transformer*` ...
std::optional<ValueId> robot_global(std::string_view name, ValueStore& values);

}  // namespace parallax::compiler
