#pragma once

#include <string>

#include "tools/diff/gate.h"

namespace parallax::tools {

/// Is it a folder of a project, and not that of a run?
bool is_tree(const std::string& path);

/// Checks the change from one folder to another against the rules about models: every scenario, and
/// every model that a manifest names, that both have at the same place and that reads a file that
/// changed. What reads none is neither compiled nor compared. Rules are named `FILE: RULE`; where
/// all are kept one line says so. A scenario or model that is gone, or cannot be read, is not
/// decidable. Reports kNoGateRules where the rules have none about models.
base::Result<GateReport> hold_tree_gate(const std::string& old_folder,
                                        const std::string& new_folder,
                                        const harness::GateRules& rules,
                                        const ModelDiffOptions& options, Context& context);

}  // namespace parallax::tools
