#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/ground/ground_model.h"
#include "compiler/pipeline/plan_formulas.h"
#include "compiler/pipeline/plan_registers.h"
#include "compiler/plan/plan_graph.h"

namespace parallax::compiler {

/// At most one of the atoms is true: a clause for each pair.
void require_at_most_one(const std::vector<FormulaId>& atoms, std::uint32_t origin,
                         GroundModel& model);

/// Values of a plan's registers at t + 1, given where control was at t. Every perform that returns
/// something picks one object that makes its formula true, and the pick has an atom of its own; a
/// register has exactly one value where the plan goes on to read it, and none elsewhere.
class RegisterStep {
 public:
  /// All outlive the object.
  RegisterStep(const PlanGraph& graph, const PlanFormulas& formulas, const PlanLiveness& liveness,
               PlanRegisters& registers, GroundModel& model, Timepoint t)
      : graph_(graph),
        formulas_(formulas),
        liveness_(liveness),
        registers_(registers),
        model_(model),
        t_(t) {}

  /// The perform of the location succeeds if it is done at t. None: reported.
  std::optional<FormulaId> success(LocationId id);
  /// To be called behind `success` of the same location: control leaves it under these conditions.
  void leave(LocationId id, FormulaId ok, FormulaId failed, std::uint32_t origin);
  /// Excludes every value that was not added. To be called last.
  void finish(std::uint32_t origin);

 private:
  struct Way {
    const PlanRegisters::Value* value;
    FormulaId good;  // the success formula for this value
  };
  void pick(const PlanLocation& location, FormulaId ok, std::uint32_t origin);
  void carry(const RegisterSet& live, std::optional<ModelValueId> fresh, FormulaId condition,
             std::uint32_t origin);

  const PlanGraph& graph_;
  const PlanFormulas& formulas_;
  const PlanLiveness& liveness_;
  PlanRegisters& registers_;
  GroundModel& model_;
  Timepoint t_;
  std::vector<Way> ways_;  // of the location that `success` was called for
  std::map<std::string, std::pair<FormulaId, std::vector<FormulaId>>> picked_;  // and reasons
  std::map<ModelValueId, std::vector<FormulaId>> live_;  // why a register has a value at t + 1
};

}  // namespace parallax::compiler
