#include "compiler/builtins/unknown_values.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <numbers>
#include <vector>

#include "compiler/builtins/builtin_call.h"

namespace parallax::compiler {
namespace {

/// A part that a constructor is given as an argument.
struct Part {
  std::string_view constructor;
  std::string_view accessor;
  std::size_t argument;
};
constexpr Part kParts[] = {
    {"make-3d-vector", "x", 0},
    {"make-3d-vector", "y", 1},
    {"make-3d-vector", "z", 2},
    {"make-quaternion", "x", 0},
    {"make-quaternion", "y", 1},
    {"make-quaternion", "z", 2},
    {"make-quaternion", "w", 3},
    {"make-pose", "origin", 0},
    {"make-pose", "orientation", 1},
    {"make-transform", "translation", 0},
    {"make-transform", "rotation", 1},
    {"make-pose-stamped", "frame-id", 0},
    {"make-pose-stamped", "stamp", 1},
    {"make-pose-stamped", "origin", 2},
    {"make-pose-stamped", "orientation", 3},
    {"make-transform-stamped", "frame-id", 0},
    {"make-transform-stamped", "child-frame-id", 1},
    {"make-transform-stamped", "stamp", 2},
    {"make-transform-stamped", "translation", 3},
    {"make-transform-stamped", "rotation", 4},
    {"pose->pose-stamped", "frame-id", 0},
    {"pose->pose-stamped", "stamp", 1},
    {"transform->transform-stamped", "frame-id", 0},
    {"transform->transform-stamped", "child-frame-id", 1},
    {"transform->transform-stamped", "stamp", 2},
};

constexpr std::string_view kComputing[] = {"+",  "-",  "*",   "/",   "min",  "max", "abs",
                                           "1+", "1-", "sin", "cos", "sqrt", "atan"};
constexpr std::string_view kAsking[] = {
    "=",     "/=",     "<",  ">",       "<=",    ">=",    "eq",     "eql",          "%same",
    "equal", "equalp", "q=", "numberp", "zerop", "plusp", "minusp", "poses-equal-p"};

template <std::size_t kSize>
bool among(const std::string_view (&names)[kSize], std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

bool computes_poses(std::string_view name) {
  for (const auto table : {pose_part_builtins(), transform_builtins(), frame_builtins()}) {
    for (const auto& entry : table) {
      if (entry.builtin.name == name) return true;
    }
  }
  return false;
}

struct RobotGlobal {
  std::string_view name;
  std::string_view frame;  // empty: only the robot knows it
};
constexpr RobotGlobal kGlobals[] = {
    {"*fixed-frame*", "map"},         {"*transformer*", ""},
    {"*robot-base-frame*", ""},       {"*odom-frame*", ""},
    {"*robot-torso-frame*", ""},      {"*robot-left-tool-frame*", ""},
    {"*robot-right-tool-frame*", ""}, {"*tf-default-timeout*", ""},
};

}  // namespace

ValueId unknown_value(std::string_view function, std::span<const ValueId> arguments,
                      ValueStore& values) {
  Value value;
  value.kind = ValueKind::kUnknown;
  value.text = function;
  value.head = values.list({arguments.begin(), arguments.end()});
  return values.intern(std::move(value));
}

bool is_robot_time(const Value& value) {
  return value.kind == ValueKind::kUnknown && value.text == "ros-time";
}

std::string_view origin_of_unknown(const ValueStore& values, ValueId id) {
  for (;;) {
    std::optional<ValueId> further;
    for (const auto argument : values.elements(values[id].head).value_or(std::vector<ValueId>())) {
      if (!further && values.kind(argument) == ValueKind::kUnknown) further = argument;
    }
    if (!further || is_unknown_source(values[id].text)) return values[id].text;
    id = *further;
  }
}

std::optional<BuiltinResult> with_unknown(std::string_view builtin, std::span<const ValueId> passed,
                                          ValueStore& values) {
  const auto is_unknown = [&](ValueId argument) {
    return values.kind(argument) == ValueKind::kUnknown;
  };
  // A location that says no pose is its own reference; where a pose is needed, the robot knows it.
  const auto is_location = [&](ValueId argument) {
    const auto& value = values[argument];
    return value.kind == ValueKind::kDesignator && value.designator == DesignatorKind::kLocation;
  };
  // Checked at every call: known arguments cost no more than this.
  const bool located =
      std::any_of(passed.begin(), passed.end(), is_location) && computes_poses(builtin);
  if (!located && std::none_of(passed.begin(), passed.end(), is_unknown)) return std::nullopt;
  std::vector<ValueId> arguments(passed.begin(), passed.end());
  for (auto& argument : arguments) {
    if (located && is_location(argument)) {
      argument = unknown_value("reference", std::span(&argument, 1), values);
    }
  }
  const bool poses = computes_poses(builtin);
  const auto unknown = std::find_if(arguments.begin(), arguments.end(), [&](ValueId argument) {
    const auto& value = values[argument];
    return value.kind == ValueKind::kUnknown && !(poses && is_robot_time(value));
  });
  if (unknown == arguments.end()) return std::nullopt;
  if (among(kAsking, builtin)) {
    const bool other = std::any_of(arguments.begin(), arguments.end(), [&](ValueId argument) {
      const auto kind = values.kind(argument);
      return kind == ValueKind::kNil || kind == ValueKind::kSymbol;
    });
    if (other) return BuiltinResult(values.nil());  // whatever it is, it is not that
    return BuiltinResult(BuiltinFailure{
        BuiltinError::kValue,
        fmt::format("argument {} is {}; ask the model with `(holds '(fluent argument...))`",
                    unknown - arguments.begin() + 1, values.print(*unknown))});
  }
  if (arguments.size() == 1) {
    for (const auto& part : kParts) {
      if (part.accessor != builtin || part.constructor != values[*unknown].text) continue;
      const auto given = values.elements(values[*unknown].head);
      if (given && part.argument < given->size()) return BuiltinResult((*given)[part.argument]);
    }
  }
  if (!among(kComputing, builtin) && !poses) return std::nullopt;
  return BuiltinResult(unknown_value(builtin, arguments, values));
}

std::optional<ValueId> robot_global(std::string_view name, ValueStore& values) {
  if (name == "pi") return values.number(Number::inexact(std::numbers::pi, Number::Kind::kDouble));
  for (const auto& global : kGlobals) {
    if (global.name != name) continue;
    if (global.frame.empty()) return unknown_value(name, {}, values);
    return values.string(global.frame);
  }
  return std::nullopt;
}

}  // namespace parallax::compiler
