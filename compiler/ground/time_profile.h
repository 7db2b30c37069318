#pragma once

#include <cstdint>
#include <optional>

#include "compiler/artifact/literal.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// How a formula depends on time.
enum class TimeShape : std::uint8_t {
  kRigid,    // no HoldsAt, ReleasedAt, Happens or effect atom
  kFixed,    // every timepoint is an integer
  kUniform,  // one universal time variable, used for nothing but timepoints `time + c`
  kMixed,    // anything else
};

struct TimeProfile {
  TimeShape shape = TimeShape::kRigid;
  // kUniform:
  VariableId variable;
  Timepoint back = 0;   // the variable's value at which the earliest timepoint is 0
  Timepoint width = 0;  // the horizon that the formula needs then; it holds 0 .. horizon - width
  // kFixed:
  Timepoint last = 0;  // the latest timepoint in it
};

/// Linear in the formula. `variable` of a uniform formula stands in the quantifiers at its root, or
/// is the `free` one.
TimeProfile time_profile(const TypedModel& model, TypedFormulaId formula,
                         std::optional<VariableId> free = std::nullopt);

/// The same for an effect axiom: uniform if its condition speaks of the event's own timepoint and
/// the one after it only.
TimeProfile time_profile(const TypedModel& model, const EffectAxiom& effect);

}  // namespace parallax::compiler
