#pragma once

#include <functional>
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
  /// quantifies over them; give each its value before grounding.
  std::map<ModelValueId, VariableId> registers;
  /// The quantified variable that is returned, for a perform that returns something.
  std::optional<VariableId> returned;
};

struct PlanFormulas {
  std::vector<PlanFormula> success;    // by location
  std::vector<PlanFormula> guards;     // by branch; empty for free ones
  std::vector<SortId> register_sorts;  // by register
};

/// The sort of the first argument place at which one of the leaves stands.
std::optional<SortId> sort_by_use(const TypedModel& model, const FormulaTree& formula,
                                  const std::function<bool(const FormulaNode&)>& is_meant);

/// Checks success conditions and guards; they become part of the model's stores, so this comes
/// before grounding. A quantified variable whose name begins with no sort (`exists i.`) has the
/// sort of the first argument place that it stands at. Reports errors at the binding's formula,
/// E4001 if it returns a variable that its outermost `{...}` does not bind.
base::Result<PlanFormulas> check_plan_formulas(const PlanGraph& graph, TypedModel& model,
                                               base::SourceFiles& files,
                                               base::DiagnosticSink& sink);

}  // namespace parallax::compiler
