#pragma once

#include <filesystem>

#include "tools/cli/scenario_model.h"

namespace parallax::tools {

/// As load_scenario_model and compile_models, with a model that was grounded without settling
/// anything in advance, so that every axiom's clauses say what it says: for explanations. Models
/// that were compiled before are taken as they are.
base::Result<ScenarioModel> load_plain_scenario(const std::filesystem::path& path,
                                                Invocation& invocation);
base::Result<compiler::Compilation> compile_plain_models(const ModelOptions& options,
                                                         Invocation& invocation);

}  // namespace parallax::tools
