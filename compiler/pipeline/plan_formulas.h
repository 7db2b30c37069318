#pragma once

#include <map>
#include <optional>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/plan/plan_graph.h"
#include "compiler/sema/check.h"

namespace parallax::compiler {

/// A formula of the plan, checked against the model.
struct PlanFormula {
  CheckedFormula checked;
  /// The model's variable that stands for each register (`?item1`) of the text. The formula
  /// quantifies over them; whoever grounds it gives each its value first.
  std::map<ModelValueId, VariableId> registers;
  /// Of a perform that returns something: the quantified variable that is returned.
  std::optional<VariableId> returned;
};

struct PlanFormulas {
  std::vector<PlanFormula> success;    // by location
  std::vector<PlanFormula> guards;     // by branch; of free ones empty
  std::vector<SortId> register_sorts;  // by register: what it can hold
};

/// Parses and checks success conditions and guards; they become part of the model's stores, so
/// this comes before grounding. Reports at the binding's formula what is wrong with it, E4001 if it
/// returns a variable that its outermost `{...}` does not bind.
base::Result<PlanFormulas> check_plan_formulas(const PlanGraph& graph, TypedModel& model,
                                               base::SourceFiles& files,
                                               base::DiagnosticSink& sink);

}  // namespace parallax::compiler
