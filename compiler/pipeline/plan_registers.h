#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/ground/formula_grounder.h"
#include "compiler/pipeline/plan_formulas.h"
#include "compiler/plan/plan_graph.h"
#include "compiler/plan/plan_liveness.h"

namespace parallax::compiler {

/// The registers of a plan as atoms: `?item1=cup1` at t, for every value that its sort has.
/// Grounds formulas that read registers or quantify over what is returned.
class PlanRegisters {
 public:
  /// All outlive the object.
  PlanRegisters(const PlanGraph& graph, const PlanFormulas& formulas, GroundModel& model,
                FormulaGrounder& grounder, base::DiagnosticSink& sink);

  struct Value {
    GroundTermId term;
    std::string name;
  };
  const std::vector<Value>& values(ModelValueId id) const { return values_[id.index()]; }
  FormulaId holds(ModelValueId id, const Value& value, Timepoint t);
  /// What the perform of the timepoint before returned.
  FormulaId returned(const Value& value, Timepoint t);

  /// One way to give the registers in a text their values, and the text with these values.
  struct Reading {
    std::vector<std::pair<ModelValueId, std::size_t>> choice;  // place in values()
    std::string text;
  };
  /// The product of the values; the text itself if it reads no register.
  std::vector<Reading> readings(const std::string& text) const;
  /// The registers have these values at t.
  FormulaId condition(const Reading& reading, Timepoint t);

  /// The formula with its own time variable at `when`, registers read at `read`. An instance that
  /// says nothing is false; if all say nothing that is reported (E3004) and the answer none.
  std::optional<FormulaId> ground(const PlanFormula& formula, Timepoint when, Timepoint read,
                                  base::SourceRange blame,
                                  std::optional<GroundTermId> returned = std::nullopt);

 private:
  const PlanGraph& graph_;
  RegisterNames names_;
  GroundModel& model_;
  FormulaGrounder& grounder_;
  base::DiagnosticSink& sink_;
  std::vector<std::vector<Value>> values_;  // by register
};

}  // namespace parallax::compiler
