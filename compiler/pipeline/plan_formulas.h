#pragma once

#include <optional>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/plan/plan_graph.h"
#include "compiler/sema/check.h"

namespace parallax::compiler {

/// The formulas of a plan graph, checked against the model: by location and by branch.
struct PlanFormulas {
  std::vector<CheckedFormula> success;
  std::vector<CheckedFormula> guards;
};

/// Parses and checks success conditions and guards; they become part of the model's stores, so
/// this comes before grounding. Reports at the binding's formula, with a note at the perform.
base::Result<PlanFormulas> check_plan_formulas(const PlanGraph& graph, TypedModel& model,
                                               base::SourceFiles& files,
                                               base::DiagnosticSink& sink);

}  // namespace parallax::compiler
