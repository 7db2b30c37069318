#pragma once

#include <span>
#include <string_view>

namespace parallax::compiler {

// Forms that address the world around the robot rather than the robot: logging, the belief state,
// markers and the simulator's world. They are accepted and do nothing, because the model's own
// axioms describe the world. docs/reference/plan_language.md lists the names.

/// Forms that do nothing and have no value, whatever package they are of.
std::span<const std::string_view> ignored_forms();
/// Packages whose functions all do nothing.
std::span<const std::string_view> ignored_packages();
/// Functions of the simulator's packages that do nothing, with the package.
std::span<const std::string_view> ignored_functions();
/// Forms that are their body; the first argument says where or how to run.
std::span<const std::string_view> transparent_forms();

/// Is a call of that name from that package, if one is written, one of them?
bool is_ignored_call(std::string_view package, std::string_view name);

}  // namespace parallax::compiler
