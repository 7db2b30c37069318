#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <span>
#include <string_view>

#include "compiler/builtins/plan_builtins.h"

namespace parallax::compiler {

/// Arguments and context of a call to a built-in; its functions keep their bodies short.
struct BuiltinCall {
  std::span<const ValueId> args;
  const FailureClasses& classes;
  ValueStore& values;
  DesignatorLinks& links;
  std::int64_t location_samples = 0;
  std::string_view name = {};

  BuiltinFailure wrong(std::size_t index, std::string_view wanted) const {
    const auto kind = values.kind(args[index]) == ValueKind::kModel && wanted == "a list"
                          ? BuiltinError::kModelList
                          : BuiltinError::kValue;
    return {kind,
            fmt::format("argument {} is {}, not {}", index + 1, values.print(args[index]), wanted)};
  }
  const Number* number(std::size_t index) const {
    const auto& value = values[args[index]];
    return value.kind == ValueKind::kNumber ? &value.number : nullptr;
  }
};

inline BuiltinFailure not_a_number(const BuiltinCall& c, std::size_t index) {
  auto failure = c.wrong(index, "a number");
  if (c.values.kind(c.args[index]) == ValueKind::kModel) {
    failure.kind = BuiltinError::kModelComparison;
  }
  return failure;
}

/// Returns the first argument; for built-ins that assert something about a value but leave it as it
/// is.
inline BuiltinResult first_argument(const BuiltinCall& c) { return c.args[0]; }

/// `eql` and `equal` of Lisp. A match of what may be two things there is noted.
bool is_same(const BuiltinCall& c, ValueId a, ValueId b);
bool is_equal(const BuiltinCall& c, ValueId a, ValueId b);

/// Functions that make a fluent of fluents: CRAM's package gives them the names of Lisp's.
bool takes_fluents(std::string_view builtin);
bool is_fluent(const Value& value);
BuiltinResult fluent_network(const BuiltinCall& c);

using BuiltinFunction = BuiltinResult (*)(const BuiltinCall&);
struct BuiltinEntry {
  PlanBuiltin builtin;
  BuiltinFunction function;
};

// The parts of the table, by topic.
std::span<const BuiltinEntry> number_builtins();
std::span<const BuiltinEntry> list_builtins();
std::span<const BuiltinEntry> sequence_builtins();
std::span<const BuiltinEntry> pattern_builtins();
std::span<const BuiltinEntry> type_builtins();
std::span<const BuiltinEntry> symbol_builtins();
std::span<const BuiltinEntry> designator_builtins();
std::span<const BuiltinEntry> pose_part_builtins();
std::span<const BuiltinEntry> transform_builtins();
std::span<const BuiltinEntry> frame_builtins();
std::span<const BuiltinEntry> robot_builtins();
std::span<const BuiltinEntry> cell_builtins();

}  // namespace parallax::compiler
