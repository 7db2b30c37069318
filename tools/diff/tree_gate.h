#pragma once

#include <string>

#include "tools/diff/gate.h"

namespace parallax::tools {

/// Is it a folder of a project, and not that of a run?
bool is_tree(const std::string& path);

/// Checks the change from one folder to another, the paths of `folders`: against the rules about
/// models every scenario, every model that a manifest names, and every other `.e` file that none of
/// these reads, and against those about rates every result of `rates --json`, that both have at the
/// same place and of which a file changed, wherever that lies. What reads none is neither compiled
/// nor compared. Rules are named `FILE: RULE`; where all are kept one line says so. What is gone or
/// cannot be read is not decidable, and neither is a change of folders that hold nothing of this.
/// Where `folders` does not say where each side has the files of commands, a folder has them at the
/// place that they have in the other. Reports kNoGateRules where the rules have neither section.
base::Result<GateReport> hold_tree_gate(const GateInput& folders, const harness::GateRules& rules,
                                        Context& context);

}  // namespace parallax::tools
