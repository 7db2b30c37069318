#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/plan/plan_binding.h"
#include "compiler/repair/plan_text.h"
#include "tools/repair/plan_candidates.h"
#include "tools/repair/plan_search.h"
#include "tools/repair/repair_input.h"

namespace parallax::tools {

/// The plan of a scenario as text, with its binding table.
struct PlanSource {
  compiler::PlanText text;
  compiler::PlanBinding binding;
};
/// None: there is no plan that could be edited.
std::optional<PlanSource> read_plan(const RepairInput& input, Context& context);

/// A step at which a run and the model parted, and where the plan was. It refers to the input and
/// the source that it was made of.
struct PlanStep {
  PlanTask task;  // without `model`
  PlanScope scope;
  Evidence::State differing;  // what held in front of the step and never where it went well
  bool went_well = false;     // its event did, in some run
};
/// None: there is no goal that could be asked for from there. `remarks` tell where the plan itself
/// is wrong.
std::optional<PlanStep> find_plan_step(const RepairInput& input, const PlanSource& source,
                                       const RunParting& parting, Context& context,
                                       std::vector<std::string>& remarks);

/// The plan of a task with these changes of its text, and a model. Null: `wrong`.
std::unique_ptr<PlanModel> compile_plan(const PlanTask& task, const std::string& model,
                                        const std::vector<compiler::TextChange>& changes,
                                        bool constraints, Context& context,
                                        PlanModel::Wrong& wrong);

/// Do the runs of the scenario end where its constraints hold?
bool has_constraints(const harness::Scenario& scenario);
/// A fluent, perhaps with arguments, that follows from others.
bool is_defined(const RepairInput& input, const std::string& fluent);

}  // namespace parallax::tools
