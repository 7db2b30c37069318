#pragma once

#include <string>

#include "tools/cli/command.h"
#include "tools/diff/gate.h"

namespace parallax::tools {

/// `diff --gate RULES`: the rules, and the Markdown to write; empty: none.
struct GateFiles {
  std::string rules, markdown;
};

/// Checks the change against the rules, prints the results, and writes the Markdown with a picture
/// beside it where a discrepancy of a run can be drawn. 1 unless the gate passes.
int run_gate(const GateInput& input, const GateFiles& files, Invocation& invocation);

}  // namespace parallax::tools
