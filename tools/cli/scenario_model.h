#pragma once

#include <filesystem>
#include <string>

#include "compiler/pipeline/compile.h"
#include "harness/config/scenario.h"
#include "tools/cli/command.h"
#include "tools/cli/model_options.h"

namespace parallax::tools {

/// A scenario with its compiled model.
struct ScenarioModel {
  harness::Scenario scenario;
  compiler::Compilation compilation;
  std::string sources_hash;   // over every text that was read
  std::string scenario_hash;  // over the scenario and what it includes
};

/// Reads the scenario, compiles model, plan and constraints, and holds the mapping and the actions
/// against the model. `costs`: also count what each axiom costs.
base::Result<ScenarioModel> load_scenario_model(const std::filesystem::path& path,
                                                Invocation& invocation, bool costs = false);

/// What the models on the command line compile to; a single .yaml is a scenario, a single .cnf has
/// been compiled before and brings neither the checked model nor the plan's graph.
base::Result<compiler::Compilation> compile_models(const ModelOptions& options,
                                                   Invocation& invocation);

}  // namespace parallax::tools
