#pragma once

#include <string>
#include <vector>

#include "runtime/enumerate/plan_enumerator.h"

namespace parallax::tools {

/// What the exploration did not follow, one sentence each: "bound reached: `loop` at
/// plan.lisp:3:5", "the plan goes on beyond timepoint 20 with Go(r1) at plan.lisp:9:3".
std::vector<std::string> open_end_texts(const compiler::CompiledModel& model,
                                        const runtime::OpenEnds& ends);

/// "plan.lisp:3:5"; empty for a place that is not known.
std::string place_text(const compiler::TextPlace& place);

/// `"bounds":["..."],`, empty without any.
std::string bounds_field(const std::vector<std::string>& bounds);

}  // namespace parallax::tools
