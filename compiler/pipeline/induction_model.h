#pragma once

#include <optional>

#include "compiler/pipeline/compile.h"

namespace parallax::compiler {

/// The shape of a model and a property, as induction over timepoints uses it.
struct InductionShape {
  Timepoint last_fixed = -1;  // the latest timepoint that some axiom names as a number; -1: none
  Timepoint width = 1;        // how many timepoints later the widest axiom reaches
  // The property:
  TypedFormulaId formula;
  std::optional<VariableId> time;  // the timepoint that it is about
  bool negated = false;            // it is broken where the formula is false, else where it is true
  Timepoint back = 0;              // how many timepoints before `time` it looks
  Timepoint ahead = 0;             // 1 if it speaks of events at `time`
  base::SourceRange source;
};

/// Does the model say the same of every timepoint after the last one that it names? Everything
/// that does not is reported at its place (kNoInduction): a formula that relates several timepoints
/// or computes with them, an effect at one timepoint, a trajectory, an argument that is a
/// timepoint, a completed predicate with a reason at another timepoint. So is a property that is
/// not about one timepoint and those before it. `compilation` has the negated property as its only
/// constraint, and no plan.
base::Result<InductionShape> induction_shape(const Compilation& compilation,
                                             base::DiagnosticSink& sink);

/// The model with an atom kHit for each timepoint at which the property can be evaluated: it is
/// true exactly where the property is broken. With `stretch` every trace of that many steps that
/// can begin at some timepoint after `last_fixed` is a trace of the result: axioms about single
/// timepoints are left out, and what has been released before is open.
base::Result<CompiledModel> compile_breaks(const TypedModel& model, const InductionShape& shape,
                                           std::optional<Timepoint> stretch,
                                           const GroundOptions& options,
                                           base::DiagnosticSink& sink);

}  // namespace parallax::compiler
