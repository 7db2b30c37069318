#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/ground/formula_grounder.h"
#include "compiler/pipeline/plan_formulas.h"
#include "compiler/plan/plan_graph.h"

namespace parallax::compiler {

/// The registers of a plan as atoms: `?item1=cup1` at t, for every value that its sort has. Grounds
/// formulas that read registers or quantify over returned objects.
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
  /// Atom for the object that the perform at the timepoint before t returned.
  FormulaId returned(const Value& value, Timepoint t);

  /// One way to give registers their values: the place of each in values().
  using Reading = std::map<ModelValueId, std::size_t>;
  /// All readings of the registers that an event reads, the product of their values; one empty
  /// reading if it reads no register.
  std::vector<Reading> readings(const FormulaTree& event) const;
  /// An event with these values; none if the model has no such constant, constructor or event.
  std::optional<GroundTermId> event(const FormulaTree& event, const Reading& reading);
  std::string event_text(const FormulaTree& event, const Reading& reading) const;
  /// The registers have these values at t.
  FormulaId condition(const Reading& reading, Timepoint t);

  /// The formula with its own time variable at `when`, registers read at `read`. Instances that do
  /// not exist are false; if none exists, that is reported (E3004) and the answer none.
  std::optional<FormulaId> ground(const PlanFormula& formula, Timepoint when, Timepoint read,
                                  base::SourceRange blame,
                                  std::optional<GroundTermId> returned = std::nullopt);

 private:
  const PlanGraph& graph_;
  GroundModel& model_;
  FormulaGrounder& grounder_;
  base::DiagnosticSink& sink_;
  std::vector<std::vector<Value>> values_;  // by register
};

}  // namespace parallax::compiler
