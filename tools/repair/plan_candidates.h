#pragma once

#include <set>
#include <string>
#include <vector>

#include "compiler/plan/plan_binding.h"
#include "compiler/repair/plan_edit.h"
#include "compiler/sema/typed_model.h"
#include "tools/app/context.h"
#include "tools/repair/evidence.h"

namespace parallax::tools {

/// The places at which a plan may be edited, and the objects of the edits.
struct PlanScope {
  const compiler::PlanText* plan = nullptr;
  const compiler::PlanBinding* binding = nullptr;
  const compiler::TypedModel* typed = nullptr;
  std::vector<compiler::DatumId> sites;    // statements on the way to the step, the nearest first
  std::vector<compiler::DatumId> failing;  // the perform at the step and the calls that lead to it
  std::string failure;                     // the class that it fails with
  std::vector<std::string> conditions;     // where the step went well, as the plan would ask
};

/// Actions whose events are among `events` in front of the sites, and statements that are such
/// actions moved there, from the same function.
std::vector<compiler::PlanEdit> plan_insertions(const PlanScope& scope,
                                                const std::set<std::string>& events);
std::vector<compiler::PlanEdit> plan_moves(const PlanScope& scope,
                                           const std::set<std::string>& events);
/// Guards and handlers around the failing forms.
std::vector<compiler::PlanEdit> plan_guards(const PlanScope& scope);
std::vector<compiler::PlanEdit> plan_handlers(const PlanScope& scope);

/// The events with an effect on conditions of `event` that the model has and the original one had
/// not, or on `fluents`; `wide`: on all conditions of `event`, and on those of these events. For
/// noninertial fluents in `defined`, the fluents of their definitions count.
std::set<std::string> events_that_matter(const std::string& model, const std::string& original,
                                         const std::string& event,
                                         const std::set<std::string>& fluents,
                                         const std::set<std::string>& defined, bool wide);

}  // namespace parallax::tools
