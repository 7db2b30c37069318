#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "compiler/pipeline/compile.h"
#include "runtime/trace/trace.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// Where a trace breaks a temporal property.
struct PropertyBreak {
  std::string formula;  // the part of the property that decides, as it is written
  std::int64_t at = 0;
  std::string text;  // "does not hold at timepoint 3"
};

/// Checks by independent means that a trace violates a property.
class PropertyCheck {
 public:
  /// All outlive the check. `strict`: that the check cannot be made is an error (E7202).
  PropertyCheck(const compiler::TypedModel& typed, const compiler::StateConstraint& property,
                bool strict, Context& context)
      : typed_(typed), property_(property), strict_(strict), context_(context) {}

  /// None: the check could not be made, or the property holds in the trace, which is reported as a
  /// disagreement (E7201).
  std::optional<PropertyBreak> broken(const runtime::Trace& trace);

 private:
  const compiler::TypedModel& typed_;
  const compiler::StateConstraint& property_;
  bool strict_;
  Context& context_;
};

}  // namespace parallax::tools
