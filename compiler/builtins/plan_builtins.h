#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "compiler/builtins/designator_links.h"
#include "compiler/builtins/plan_value.h"
#include "compiler/plan/failure_classes.h"

namespace parallax::compiler {

/// Built-in functions on values that are known while unrolling: arithmetic, comparison, lists,
/// poses, designator access.
struct PlanBuiltin {
  std::string_view name;
  std::uint32_t min_arguments = 0;
  std::uint32_t max_arguments = 0;  // kAnyNumber: no limit
};
inline constexpr std::uint32_t kAnyNumber = 1000000;

std::span<const PlanBuiltin> plan_builtins();
std::optional<std::uint32_t> find_builtin(std::string_view name);

/// Only the model knows whether two values are the same.
struct ModelEquality {
  ValueId left;
  ValueId right;
};
/// kRaise: the plan fails, with the class in the text.
enum class BuiltinError : std::uint8_t { kValue, kModelComparison, kModelList, kRaise };
struct BuiltinFailure {
  BuiltinError kind = BuiltinError::kValue;
  std::string text;  // the error in the arguments
};
using BuiltinResult = std::variant<ValueId, ModelEquality, BuiltinFailure>;

/// Computes one built-in; `location_samples`: further solutions of a location. Pure but for new
/// values in the store. The number of arguments is right.
BuiltinResult call_builtin(std::uint32_t builtin, std::span<const ValueId> arguments,
                           const FailureClasses& classes, std::int64_t location_samples,
                           DesignatorLinks& links, ValueStore& values);

}  // namespace parallax::compiler
