#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "compiler/repair/plan_edit.h"
#include "tools/repair/plan_model.h"

namespace parallax::tools {

/// Edits of a plan that help, found by a solver in one compiled plan that contains all candidates,
/// each behind a guard of its own.
struct PlanChoice {
  std::vector<std::size_t> edits;
  /// For an insertion that was found: the fluents that its actions change, with their values
  /// before.
  std::vector<std::pair<std::string, bool>> undone;
};

struct PlanTask {
  const harness::Scenario* scenario = nullptr;
  const compiler::PlanText* plan = nullptr;
  std::string model;  // text
  std::int64_t horizon = 0;
  const Evidence* evidence = nullptr;  // of the run that left the model
  std::size_t step = 0;                // where it did
  BadStep bad;
  PlanGoal goal;
};

/// `handles`: the step goes wrong as it did in the run, and the plan gets there all the same; else
/// it has no bad step. Sets of at most `most` edits, smaller ones first, at most `limit`. Edits
/// that make the plan wrong are left out.
std::vector<PlanChoice> find_plan_edits(const PlanTask& task,
                                        const std::vector<compiler::PlanEdit>& edits, bool handles,
                                        std::size_t most, std::size_t limit, Context& context,
                                        std::vector<std::string>& remarks);

}  // namespace parallax::tools
