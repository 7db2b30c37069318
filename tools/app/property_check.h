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

/// Holds the trace that is said to violate a property against the property by independent means.
class PropertyCheck {
 public:
  /// All outlive the check. `strict`: that the check cannot be made is an error (E7202).
  PropertyCheck(const compiler::TypedModel& typed, const compiler::StateConstraint& property,
                bool strict, Context& context)
      : typed_(typed), property_(property), strict_(strict), context_(context) {}

  /// None: it could not be found out, or the property is true of the trace, which is reported as
  /// the disagreement that it is (E7201).
  std::optional<PropertyBreak> broken(const runtime::Trace& trace);

 private:
  const compiler::TypedModel& typed_;
  const compiler::StateConstraint& property_;
  bool strict_;
  Context& context_;
};

}  // namespace parallax::tools
