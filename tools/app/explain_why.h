#pragma once

#include <cstdint>
#include <string>

#include "compiler/artifact/compiled_model.h"
#include "tools/app/context.h"

namespace parallax::tools {

struct WhyCommand {
  std::string fact;        // `HoldsAt(F,3)`, `!HoldsAt(F(a),3)`, `Happens(E(),2)`
  std::int64_t trace = 1;  // its number in the list of traces
  bool all = false;        // tell further causes as well
};

/// Tells the chain of facts behind one fact of a trace. Reports kNoSuchFact and kNoSuchTrace.
int explain_why(const compiler::CompiledModel& model, const WhyCommand& command, Context& context);

}  // namespace parallax::tools
