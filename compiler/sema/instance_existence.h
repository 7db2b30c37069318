#pragma once

#include <set>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Can an instance of the formula name something that does not exist: an argument outside of its
/// sort, a timepoint, an occurrence at the last timepoint? The variables (by index) in
/// `before_last` are known to be timepoints before the last one. True where it cannot be told.
bool may_lack_instances(const TypedModel& model, TypedFormulaId formula,
                        const std::set<std::uint32_t>& before_last);

/// Adds the times of the events and effects under the formula's conjunctions: where an instance of
/// the whole formula exists, these are timepoints before the last one.
void collect_event_times(const TypedModel& model, TypedFormulaId formula,
                         std::set<std::uint32_t>& before_last);

/// Makes a formula that is true, and whose instances exist where those of `formula` do. An effect
/// or trajectory in it stands for what it names: the event's occurrence and the states.
TypedFormulaId existence_formula(TypedModel& model, TypedFormulaId formula);

}  // namespace parallax::compiler
