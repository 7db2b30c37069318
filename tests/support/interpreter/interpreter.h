#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "tests/support/interpreter/datum.h"
#include "tests/support/interpreter/world.h"

namespace parallax::test {

/// All executions of a plan, from all initial states and with every choice of a returned object.
struct Executions {
  std::set<std::string> keys;      // executions that met the constraint, up to that point
  bool beyond_horizon = false;     // some went on beyond it without having met the constraint
  std::set<std::string> failures;  // classes that nobody handled, in executions that ended
  std::size_t runs = 0;
};

/// Executes the plan, form by form, on one state at a time. Throws std::runtime_error for forms
/// that it does not know. The plan's bare top-level forms are run, or else its last function.
/// `by_turns`: the branches of `par` and `pursue` in every order of their performs and questions.
/// Throws std::length_error for more than `most` runs.
Executions execute_all(std::string_view plan, World& world, int horizon, bool by_turns = false,
                       std::size_t most = SIZE_MAX);

}  // namespace parallax::test
