#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/interpreter/datum.h"
#include "tests/support/interpreter/rule_world.h"

namespace parallax::test {

/// A plan, a model and a horizon.
struct PlanCase {
  RuleModel model;
  std::vector<Datum> plan;
  int horizon = 0;
  bool by_turns = false;  // the branches of `par` and `pursue`
  std::string plan_text() const;
};

/// The same for the same seed, on every machine.
PlanCase random_plan_case(std::uint64_t seed);

/// Makes the case smaller, rule by rule and form by form, as long as `fails` holds of it.
PlanCase shrunk(PlanCase found, const std::function<bool(const PlanCase&)>& fails);

}  // namespace parallax::test
