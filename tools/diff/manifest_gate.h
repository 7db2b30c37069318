#pragma once

#include <string>

#include "tools/diff/gate.h"
#include "tools/diff/gate_tree.h"

namespace parallax::tools {

/// Holds the cases of a manifest that both folders have against the rules: which cases there are,
/// and of each one what it expects and, where its models are compiled together or up to a horizon
/// of the case, these models. A model that is a case by itself is compared as a file.
void hold_manifest(const std::string& name, const GateTree& before, const GateTree& after,
                   const harness::GateRules& rules, const GateInput& folders, SameFiles& same,
                   GateReport& out, Context& context);

}  // namespace parallax::tools
